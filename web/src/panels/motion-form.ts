// The form of a base motion, and what the server is asked for it.

import { COORDINATES } from '../state/answers'
import type { KeyOf, Options } from '../state/options'
import { page, type Question, store } from '../state/store'
import { choose, numberBox } from '../widgets/bound'
import { freshId, h, status } from '../widgets/dom'

const MOST_CSV = 4 * 1024 * 1024
const CSV_LABEL = 'columns time and x, y, z, roll, pitch, yaw (s, m, rad; or z_mm, roll_deg…)'
const MOTIONS = [
  ['harmonic', 'Harmonic'],
  ['sweep', 'Swept sine'],
  ['shock', 'Half-sine shock'],
  ['step', 'Smooth step'],
  ['csv', 'Recorded (CSV)'],
] as const
const AXES = COORDINATES.map((c) => [c, c] as const)

type Kind = Options['motion']

/** The numbers that a motion takes, beside the duration. */
const USED: Record<Kind, KeyOf<number>[]> = {
  harmonic: ['amplitude', 'frequency'],
  sweep: ['amplitude', 'frequency', 'end'],
  shock: ['peak', 'pulse'],
  step: ['amplitude', 'pulse'],
  csv: [],
}
const RISES =
  'A sine rises over the first tenth of the duration, so that it starts from rest: its first peaks are smaller.'

const turning = () => COORDINATES.indexOf(page.motion_axis) > 2

/** A CSV file that a person chose: its text, or why there is none. */
class RecordedMotion {
  readonly element: HTMLElement
  readonly words = status({ class: 'hint' })
  text = ''
  why = 'Choose a CSV file first.'
  private readonly file = h('input', { type: 'file', accept: '.csv,text/csv', id: freshId('csv'), class: 'file' })

  constructor() {
    const label = h('label', { for: this.file.id }, CSV_LABEL)
    this.element = h('span', { class: 'field' }, label, this.file)
    this.file.addEventListener('change', () => void this.read(this.file.files?.[0]))
  }

  private async read(chosen: File | undefined): Promise<void> {
    const [text, why] = await content(chosen)
    this.text = text
    this.why = why
    this.words.textContent = why
    store.set({ motion: page.motion }) // what was simulated may be of another file
  }
}

/** The text of a file, or why it cannot be used. */
async function content(file: File | undefined): Promise<[string, string]> {
  if (!file) return ['', 'Choose a CSV file first.']
  const { name, size } = file
  if (size > MOST_CSV) {
    const most = `at most ${MOST_CSV} are taken`
    return ['', `${name} has ${size} bytes; ${most}. Shorten it or sample it more coarsely.`]
  }
  const text = await file.text()
  if (!text.trim()) return ['', `${name} is empty; choose a file with a row of column names and rows of numbers.`]
  if (text.includes('\ufffd')) return ['', `${name} is not text in UTF-8; save it as CSV in UTF-8.`]
  return [text, '']
}

export class MotionForm {
  readonly elements: HTMLElement[]
  readonly notes: HTMLElement[]
  private readonly recorded = new RecordedMotion()
  private readonly fields: Partial<Record<KeyOf<number>, HTMLElement>> = {}
  private readonly units: Partial<Record<KeyOf<number>, HTMLElement>> = {}
  private readonly axis = choose('motion_axis', 'Axis of the base motion', AXES)
  private readonly rises = h('p', { class: 'hint' }, RISES)

  constructor() {
    this.notes = [this.rises, this.recorded.words]
    this.elements = [
      choose('motion', 'Base motion', MOTIONS),
      this.axis,
      this.field('amplitude', 'amplitude', 'mm'),
      this.field('frequency', 'frequency', 'Hz'),
      this.field('end', 'to', 'Hz'),
      this.field('peak', 'peak', 'm/s²'),
      this.field('pulse', 'pulse', 'ms'),
      this.field('duration', 'duration', 's'),
      this.recorded.element,
    ]
    store.on(['motion', 'motion_axis'], () => this.show())
    this.show()
  }

  private field(key: KeyOf<number>, name: string, unit: string): HTMLElement {
    const box = numberBox(key, name)
    const suffix = h('span', { class: 'unit' }, unit)
    this.units[key] = suffix
    this.fields[key] = h('span', { class: 'field' }, h('span', {}, name), box.input, suffix, box.wrong)
    return this.fields[key]
  }

  private show(): void {
    const { motion } = page
    for (const [key, element] of Object.entries(this.fields))
      element.hidden = key !== 'duration' && !USED[motion].includes(key as KeyOf<number>)
    this.axis.hidden = motion === 'csv'
    this.recorded.element.hidden = this.recorded.words.hidden = motion !== 'csv'
    this.rises.hidden = motion !== 'harmonic' && motion !== 'sweep'
    this.units.amplitude!.textContent = turning() ? '°' : 'mm'
    this.units.peak!.textContent = turning() ? 'rad/s²' : 'm/s²'
  }

  /** What the server is asked, in SI units; only what the motion takes. */
  question(): Question {
    const { motion, duration } = page
    const asked: Question = { kind: motion, duration }
    if (motion === 'csv') return { ...asked, csv: this.recorded.text }
    asked.axis = page.motion_axis
    const factor: Partial<Record<KeyOf<number>, number>> = { amplitude: turning() ? Math.PI / 180 : 1e-3, pulse: 1e-3 }
    for (const key of USED[motion]) asked[key] = page[key] * (factor[key] ?? 1)
    return asked
  }

  /** Why nothing can be asked; '' if it can. */
  get why(): string {
    return page.motion === 'csv' ? this.recorded.why : ''
  }
}
