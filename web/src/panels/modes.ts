// The six modes: table, the animated one, and what it is made of.

import { categories } from '../charts/theme'
import type { Animation } from '../machine3d/animation'
import { drawnSize, paceWords, playButton, playMode, replaceModes } from '../snapshot/mode'
import { COORDINATES, type LoneMode, type OptionalNumber, type Snapshot } from '../state/answers'
import { page, store } from '../state/store'
import { slider } from '../widgets/bound'
import { h } from '../widgets/dom'
import { csvButton, saveCsv } from '../widgets/download'
import { percent, sig } from '../widgets/format'
import { dataTable, row, titleBar } from '../widgets/layout'

const COUPLED = 'below zero where directions are coupled, and another has more than its part'
const LEGS = [1, 2, 3, 4, 5, 6]
const COLUMNS = [
  { name: 'Mode' },
  { name: 'ω', unit: 'rad/s' },
  { name: 'f', unit: 'Hz' },
  { name: 'damped f', unit: 'Hz' },
  { name: 'damping', unit: '%' },
  { name: 'what moves' },
]
const CAPTION =
  'Six natural frequencies at this pose. Undamped by Eq. 5 of the paper; ' +
  'damped with gravity and preload by the exact tangent, beside the mode that moves alike.'
const HINT = 'Choose a mode to see it move, and which legs and directions it uses. Keys 1 to 6 do the same.'
const CSV_HEAD = [
  'mode',
  'omega_rad_s',
  'frequency_hz',
  'damped_frequency_hz',
  'damping_ratio',
  'overlap',
  'description',
  ...COORDINATES.map((c) => `kinetic_${c}`),
  ...LEGS.map((n) => `strain_leg_${n}`),
]

function pick(mode: number): void {
  store.set({ mode: mode === page.mode ? -1 : mode })
}

/** Damped frequency and damping ratio of a mode; a mode that grows is told as such. */
function dampedWords(frequency: OptionalNumber | undefined, ratio: OptionalNumber | undefined): string[] {
  const words = (ratio ?? 0) < 0 ? 'falls over' : sig(frequency)
  return [words, sig(ratio == null ? Number.NaN : 100 * ratio, 3)]
}

/** A damped mode that is like none of the undamped ones. */
function loneRow(mode: LoneMode): HTMLElement {
  const element = row(h('span', {}, '–'), ['–', '–', ...dampedWords(mode.frequency, mode.ratio)])
  element.append(h('td', { class: 'words' }, mode.text))
  return element
}

function modeRow(s: Snapshot, i: number): HTMLElement {
  const chosen = i === page.mode
  const play = playButton(i, chosen, ` (key ${i + 1})`)
  const damped = dampedWords(s.damped?.frequency[i], s.damped?.ratio[i])
  const element = row(play, [sig(s.omega[i]), sig(s.frequency[i]), ...damped])
  element.append(h('td', { class: 'words' }, s.modes[i].text))
  element.classList.toggle('chosen', chosen)
  element.addEventListener('click', () => pick(i))
  return element
}

function bars(label: string, names: readonly string[], shares: OptionalNumber[], negative = ''): HTMLElement {
  const rows = names.map((name, i) => {
    const bar = h('span', { class: 'fill' })
    bar.style.width = `${100 * Math.min(1, Math.max(0, shares[i] ?? 0))}%`
    bar.style.background = categories()[i % 6]
    const value = h('td', { class: 'value' }, percent(shares[i]))
    return h('tr', {}, h('th', { scope: 'row' }, name), h('td', { class: 'track' }, bar), value)
  })
  const why = shares.some((share) => (share ?? 0) < -0.005) ? `; ${negative}` : ''
  return h('table', { class: 'bars' }, h('caption', {}, label + why), h('tbody', {}, ...rows))
}

/** What a mode is made of, and how it is drawn. */
function details(s: Snapshot, mode: number, drawn: number, still: boolean): HTMLElement[] {
  return [
    h('p', {}, h('strong', {}, `Mode ${mode + 1}: `), s.modes[mode].text, '.'),
    h('p', { class: 'hint' }, paceWords(s, mode, drawn, still)),
    h(
      'div',
      { class: 'pair' },
      bars('Kinetic energy by direction', COORDINATES, s.modes[mode].share, COUPLED),
      bars(
        'Strain energy by leg',
        LEGS.map((n) => `leg ${n}`),
        s.strain[mode],
      ),
    ),
  ]
}

/** Plays the chosen mode, and says what it is made of. */
function player(animation: Animation): { amplitude: HTMLElement; detail: HTMLElement; play(): void } {
  const control = slider('drawn', { id: 'amplitude' })
  const words = h('output', { for: 'amplitude' })
  const detail = h('div', { class: 'detail' })
  const play = () => {
    const { snapshot: s, mode } = page
    if (!s || mode < 0) {
      animation.stop('mode')
      detail.replaceChildren(h('p', { class: 'hint' }, HINT))
      words.textContent = '–'
      return
    }
    const drawn = drawnSize(s, page.drawn)
    words.textContent = `${sig(1000 * drawn, 3)} mm`
    playMode(animation, s, mode, drawn)
    detail.replaceChildren(...details(s, mode, drawn, animation.reduced))
  }
  store.on(['drawn'], play)
  const label = h('label', { for: 'amplitude' }, 'Amplitude drawn')
  return { amplitude: h('div', { class: 'row amplitude' }, label, control, words), detail, play }
}

function write(): void {
  const s = page.snapshot
  if (!s) return
  const rows = s.omega.map((w, i) => {
    const damped = [s.damped?.frequency[i], s.damped?.ratio[i], s.damped?.overlap[i]]
    return [i + 1, w, s.frequency[i], ...damped, s.modes[i].text, ...s.modes[i].share, ...s.strain[i]]
  })
  saveCsv('modes', CSV_HEAD, rows)
}

export function modesPanel(animation: Animation): HTMLElement {
  const body = h('tbody')
  const { amplitude, detail, play } = player(animation)
  const table = () => {
    const s = page.snapshot
    if (!s) return
    replaceModes(body, [...s.omega.map((_, i) => modeRow(s, i)), ...(s.damped?.alone ?? []).map(loneRow)])
  }
  store.on(['snapshot', 'mode'], () => {
    table()
    play()
  })
  const title = titleBar('h2', 'Natural frequencies', csvButton('Table of modes', write))
  const scroll = h('div', { class: 'scroll' }, dataTable('modes-table', CAPTION, COLUMNS, body))
  return h('div', {}, title, scroll, amplitude, detail)
}
