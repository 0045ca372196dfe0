// The six legs: lengths, static forces, joint angles, and the limits they exceed.

import type { Snapshot } from '../state/answers'
import { page, store } from '../state/store'
import { h } from '../widgets/dom'
import { csvButton, saveCsv } from '../widgets/download'
import { sig } from '../widgets/format'
import { dataTable, row, titleBar } from '../widgets/layout'

const CAPTION = 'Length, static force and energy, joint angles and limits of each leg'
const AT_REST = 'Forces that hold the pose at rest under gravity; positive is compression.'
const CSV_HEAD = [
  'leg',
  'length_m',
  'static_force_n',
  'static_energy_j',
  'universal_angle_deg',
  'spherical_angle_deg',
  'exceeded',
]

const factor = () => (page.unit === 'mm' ? 1000 : 1)
const times = (value: number | null, by: number) => (value === null ? null : value * by)

function legRow(s: Snapshot, i: number): HTMLElement {
  const { length, force, energy, universal, spherical } = s.legs
  const wrong = s.limits.by_leg[i]
  const element = row(String(i + 1), [
    sig(times(length[i], factor())),
    sig(force?.[i], 4),
    sig(energy?.[i], 3),
    sig(universal[i], 3),
    sig(spherical[i], 3),
  ])
  const words = wrong.length ? h('strong', {}, `▲ ${wrong.join('; ')}`) : s.limits.any ? 'within' : 'none set'
  element.append(h('td', { class: 'words' }, words))
  element.classList.toggle('exceeded', wrong.length > 0)
  return element
}

function remarks(s: Snapshot): string {
  const distance = `Least distance between leg axes: ${sig(times(s.leg_distance, factor()), 4)} ${page.unit}.`
  const sampling = `Largest sensible sampling time of a controller: ${sig(times(s.sampling_time, 1000), 3)} ms.`
  return `${s.legs.why || AT_REST} ${distance} ${sampling}`
}

function write(): void {
  const s = page.snapshot
  if (!s) return
  const { length, force, energy, universal, spherical } = s.legs
  const rows = length.map((l, i) => {
    return [i + 1, l, force?.[i], energy?.[i], universal[i], spherical[i], s.limits.by_leg[i].join('; ')]
  })
  saveCsv('legs', CSV_HEAD, rows)
}

export function legsPanel(): HTMLElement {
  const body = h('tbody')
  const note = h('p', { class: 'hint' })
  const unit = h('small', {}, ' mm')
  store.on(['snapshot', 'unit'], () => {
    const s = page.snapshot
    if (!s) return
    body.replaceChildren(...s.legs.length.map((_, i) => legRow(s, i)))
    unit.textContent = ` ${page.unit}`
    note.textContent = remarks(s)
  })
  const columns = [
    { name: 'Leg' },
    { name: 'length', unit },
    { name: 'force', unit: 'N' },
    { name: 'energy', unit: 'J' },
    { name: 'base joint', unit: '°' },
    { name: 'platform joint', unit: '°' },
    { name: 'limits' },
  ]
  const table = dataTable('legs-table', CAPTION, columns, body)
  const title = titleBar('h2', 'Legs at rest', csvButton('Table of legs', write))
  return h('div', {}, title, h('div', { class: 'scroll' }, table), note)
}
