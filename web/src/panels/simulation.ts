// A short simulation under a base motion: its form, the job, and its playback.

import type { Animation } from '../machine3d/animation'
import { COORDINATES, type Coordinate } from '../state/answers'
import { floats } from '../state/api'
import { store } from '../state/store'
import { button, freshId, h, select } from '../widgets/dom'
import { csvButton, figureButtons } from '../widgets/download'
import { parsed } from '../widgets/format'
import { Runner } from '../widgets/job'
import { titleBar, toolBar } from '../widgets/layout'
import { Playback } from './playback'

const MOST_CSV = 4 * 1024 * 1024
const CSV_LABEL = 'columns time and x, y, z, roll, pitch, yaw (s, m, rad; or z_mm, roll_deg…)'
const HINT = 'The complete non-linear machine on a moving base, from rest at the pose.'
const MOTIONS = [
  ['harmonic', 'Harmonic'],
  ['sweep', 'Swept sine'],
  ['shock', 'Half-sine shock'],
  ['step', 'Smooth step'],
  ['csv', 'Recorded (CSV)'],
] as const

type Kind = (typeof MOTIONS)[number][0]

interface NumberField {
  element: HTMLElement
  unit: HTMLElement
  value(): number
}

function numberField(label: string, unit: string, value: string): NumberField {
  const id = freshId('time')
  const input = h('input', { type: 'text', class: 'number', inputmode: 'decimal', id, value })
  input.addEventListener('change', () => {
    input.setAttribute('aria-invalid', String(!Number.isFinite(parsed(input.value))))
  })
  const suffix = h('span', { class: 'unit' }, unit)
  const element = h('span', { class: 'field' }, h('label', { for: id }, label), input, suffix)
  return { element, unit: suffix, value: () => parsed(input.value) }
}

/** A CSV file that a person chose, and its text. */
class RecordedMotion {
  readonly element: HTMLElement
  text = ''
  private readonly file = h('input', { type: 'file', accept: '.csv,text/csv', id: freshId('csv'), class: 'file' })

  constructor(private readonly say: (words: string) => void) {
    this.element = h('span', { class: 'field' }, h('label', { for: this.file.id }, CSV_LABEL), this.file)
    this.file.addEventListener('change', () => void this.read(this.file.files?.[0]))
  }

  private async read(chosen: File | undefined): Promise<void> {
    this.text = ''
    if (!chosen) return
    if (chosen.size <= MOST_CSV) this.text = await chosen.text()
    else {
      const size = `${chosen.name} has ${chosen.size} bytes; at most ${MOST_CSV} are taken.`
      this.say(`${size} Shorten it or sample it more coarsely.`)
    }
  }
}

/** The form of a base motion. */
class MotionForm {
  readonly recorded: RecordedMotion
  private readonly kind = select('Base motion', MOTIONS, 'harmonic', () => this.show())
  private readonly axis = select(
    'Axis of the base motion',
    COORDINATES.map((c) => [c, c] as const),
    'z',
    () => this.show(),
  )
  private readonly fields = {
    amplitude: numberField('amplitude', 'mm', '1'),
    frequency: numberField('frequency', 'Hz', '5'),
    end: numberField('to', 'Hz', '50'),
    peak: numberField('peak', 'm/s²', '10'),
    pulse: numberField('pulse', 'ms', '11'),
    duration: numberField('duration', 's', '1'),
  }
  private readonly used: Record<Kind, HTMLElement[]>

  constructor(say: (words: string) => void) {
    this.recorded = new RecordedMotion(say)
    const { amplitude, frequency, end, peak, pulse } = this.fields
    this.used = {
      harmonic: [amplitude.element, frequency.element],
      sweep: [amplitude.element, frequency.element, end.element],
      shock: [peak.element, pulse.element],
      step: [amplitude.element, pulse.element],
      csv: [this.recorded.element],
    }
    this.show()
  }

  get elements(): HTMLElement[] {
    const fields = Object.values(this.fields).map((field) => field.element)
    return [this.kind.element, this.axis.element, ...fields, this.recorded.element]
  }

  private get turning(): boolean {
    return COORDINATES.indexOf(this.axis.element.value as Coordinate) > 2
  }

  private show(): void {
    const used = this.used[this.kind.element.value as Kind]
    for (const item of Object.values(this.used).flat()) item.hidden = !used.includes(item)
    this.axis.element.hidden = this.kind.element.value === 'csv'
    this.fields.amplitude.unit.textContent = this.turning ? '°' : 'mm'
    this.fields.peak.unit.textContent = this.turning ? 'rad/s²' : 'm/s²'
  }

  /** What the server is asked, in SI units; null if no file was chosen. */
  motion(): Record<string, unknown> | null {
    const { amplitude, frequency, end, peak, pulse, duration } = this.fields
    const kind = this.kind.element.value
    const csv = kind === 'csv' ? this.recorded.text : ''
    if (kind === 'csv' && !csv) return null
    return {
      kind,
      axis: this.axis.element.value,
      amplitude: amplitude.value() * (this.turning ? Math.PI / 180 : 1e-3),
      frequency: frequency.value(),
      end: end.value(),
      peak: peak.value(),
      pulse: pulse.value() / 1000,
      duration: duration.value(),
      csv,
    }
  }
}

export function timePanel(animation: Animation): HTMLElement {
  const runner = new Runner()
  const form = new MotionForm((words) => runner.say(words))
  const playback = new Playback(animation)
  const run = async () => {
    const motion = form.motion()
    if (!motion) return runner.say('Choose a CSV file first.')
    let words = ''
    const whole = await runner.run('time', { ...store.question(), ...motion }, (message, data) => {
      if (message.type !== 'run') return
      words = message.words
      playback.take({ ...message, rows: floats(data) })
    })
    if (whole) runner.say(words)
  }
  const csv = csvButton('Simulation', () => playback.csv())
  const figures = figureButtons(
    () => 'simulation',
    'Simulation',
    () => playback.figure(),
  )
  const start = button('Simulate', () => void run(), { class: 'primary', id: 'simulate' })
  return h(
    'div',
    { id: 'time' },
    titleBar('h2', 'Time simulation', csv, figures),
    h('p', { class: 'hint' }, HINT),
    toolBar(...form.elements, start),
    runner.element,
    playback.element,
  )
}
