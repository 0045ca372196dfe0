// The six modes in a cell: frequency, what moves, and the one that is animated.

import type { Animation } from '../machine3d/animation'
import { drawnSize, paceWords, playButton, playMode, replaceModes } from '../snapshot/mode'
import type { Snapshot } from '../state/answers'
import { h } from '../widgets/dom'
import { sig } from '../widgets/format'
import { dataTable, row } from '../widgets/layout'
import type { Shared } from './model'

const CAPTION = 'Six natural frequencies at this pose'
const COLUMNS = [{ name: 'Mode' }, { name: 'f', unit: 'Hz' }, { name: 'what moves' }]
const HINT = 'Choose a mode to see it move.'
const AT_FIRST = 0.35 // of the largest amplitude

function modeRow(s: Snapshot, i: number, chosen: number, pick: (mode: number) => void): HTMLElement {
  const element = row(playButton(i, i === chosen), [sig(s.frequency[i])])
  element.append(h('td', { class: 'words' }, s.modes[i].text))
  element.classList.toggle('chosen', i === chosen)
  element.addEventListener('click', () => pick(i))
  return element
}

/** `show` is called where the machine or the mode has changed. */
export function modesPart(shared: Shared, animation: Animation): { elements: HTMLElement[]; show(): void } {
  const body = h('tbody')
  const table = dataTable('modes', CAPTION, COLUMNS, body)
  table.classList.add('modes')
  const size = h('input', { type: 'range', min: 0, max: 1, step: 'any', id: 'amplitude', value: AT_FIRST })
  const words = h('output', { for: 'amplitude' })
  const pace = h('p', { class: 'hint pace' })
  const pick = (i: number) => shared.put('mode', shared.get('mode') === i + 1 ? null : i + 1)
  const play = () => {
    const [s, mode] = [shared.get('_snapshot'), (shared.get('mode') ?? 0) - 1]
    const drawn = drawnSize(s, Number(size.value))
    if (mode < 0) animation.stop('mode')
    else playMode(animation, s, mode, drawn)
    words.textContent = mode < 0 ? '–' : `${sig(1000 * drawn, 3)} mm`
    pace.textContent = mode < 0 ? HINT : paceWords(s, mode, drawn, animation.reduced)
  }
  size.addEventListener('input', play)
  const label = h('label', { for: 'amplitude' }, 'Amplitude drawn')
  return {
    elements: [table, h('div', { class: 'row amplitude' }, label, size, words), pace],
    show() {
      const [s, chosen] = [shared.get('_snapshot'), (shared.get('mode') ?? 0) - 1]
      replaceModes(
        body,
        s.frequency.map((_, i) => modeRow(s, i, chosen, pick)),
      )
      play()
    },
  }
}
