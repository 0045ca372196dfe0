// A short simulation under a base motion, and its playback in 3-D with the plots.

import { floats } from '../state/api'
import { twist, type Animation } from '../machine3d/animation'
import { categories, DASHES, onTheme } from '../charts/colours'
import { button, freshId, h, select } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { parsed, sig } from '../widgets/format'
import { LinePlot, span } from '../charts/lines'
import { Runner } from '../widgets/job'
import { page, store } from '../state/store'
import { COORDINATES } from '../state/answers'

const MOST_CSV = 4 * 1024 * 1024
const COLUMNS = 25 // time, platform displacement, base displacement, leg lengths, leg forces: 1 + 6 + 6 + 6 + 6

interface Run {
  count: number
  rows: Float32Array
  speed: number // simulated seconds in a second of playback
  factor: number // of the displacements drawn
}

interface Input {
  element: HTMLElement
  value(): number
}

function input(label: string, unit: string, value: string): Input {
  const id = freshId('time')
  const box = h('input', { type: 'text', class: 'number', inputmode: 'decimal', id, value })
  box.addEventListener('change', () => box.setAttribute('aria-invalid', String(!Number.isFinite(parsed(box.value)))))
  return {
    element: h('span', { class: 'field' }, h('label', { for: id }, label), box, h('span', { class: 'unit' }, unit)),
    value: () => parsed(box.value),
  }
}

type Kind = 'harmonic' | 'sweep' | 'shock' | 'step' | 'csv'

export function timePanel(animation: Animation): HTMLElement {
  const runner = new Runner()
  const axis = select(
    'Axis of the base motion',
    COORDINATES.map((c) => [c, c] as const),
    'z',
    () => units(),
  )
  const fields = {
    amplitude: input('amplitude', 'mm', '1'),
    frequency: input('frequency', 'Hz', '5'),
    end: input('to', 'Hz', '50'),
    peak: input('peak', 'm/s²', '10'),
    pulse: input('pulse', 'ms', '11'),
    duration: input('duration', 's', '1'),
  }
  const file = h('input', { type: 'file', accept: '.csv,text/csv', id: freshId('csv'), class: 'file' })
  let csv = ''
  const csvField = h(
    'span',
    { class: 'field' },
    h('label', { for: file.id }, 'columns time and x, y, z, roll, pitch, yaw (s, m, rad; or z_mm, roll_deg…)'),
    file,
  )
  const wants: Record<Kind, HTMLElement[]> = {
    harmonic: [fields.amplitude.element, fields.frequency.element],
    sweep: [fields.amplitude.element, fields.frequency.element, fields.end.element],
    shock: [fields.peak.element, fields.pulse.element],
    step: [fields.amplitude.element, fields.pulse.element],
    csv: [csvField],
  }
  const kind = select(
    'Base motion',
    [
      ['harmonic', 'Harmonic'],
      ['sweep', 'Swept sine'],
      ['shock', 'Half-sine shock'],
      ['step', 'Smooth step'],
      ['csv', 'Recorded (CSV)'],
    ] as const,
    'harmonic',
    () => units(),
  )
  const units = () => {
    const used = wants[kind.element.value as Kind]
    for (const list of Object.values(wants)) for (const item of list) item.hidden = !used.includes(item)
    axis.element.hidden = kind.element.value === 'csv'
    const turning = COORDINATES.indexOf(axis.element.value as 'x') > 2
    fields.amplitude.element.querySelector('.unit')!.textContent = turning ? '°' : 'mm'
    fields.peak.element.querySelector('.unit')!.textContent = turning ? 'rad/s²' : 'm/s²'
  }
  file.addEventListener('change', async () => {
    const chosen = file.files?.[0]
    csv = ''
    if (!chosen) return
    if (chosen.size > MOST_CSV)
      runner.say(
        `${chosen.name} has ${chosen.size} bytes; at most ${MOST_CSV} are taken. Shorten it or sample it more coarsely.`,
      )
    else csv = await chosen.text()
  })
  const playback = new Playback(animation)
  const run = async () => {
    if (kind.element.value === 'csv' && !csv) return runner.say('Choose a CSV file first.')
    const turning = COORDINATES.indexOf(axis.element.value as 'x') > 2
    const spec = {
      ...store.question(),
      kind: kind.element.value,
      axis: axis.element.value,
      amplitude: fields.amplitude.value() * (turning ? Math.PI / 180 : 1e-3),
      frequency: fields.frequency.value(),
      end: fields.end.value(),
      peak: fields.peak.value(),
      pulse: fields.pulse.value() / 1000,
      duration: fields.duration.value(),
      csv: kind.element.value === 'csv' ? csv : '',
    }
    let words = ''
    const whole = await runner.run('time', spec, (message, data) => {
      if (message.type !== 'run') return
      words = message.words as string
      playback.take({
        count: message.count as number,
        rows: floats(data),
        speed: message.speed as number,
        factor: message.factor as number,
      })
    })
    if (whole) runner.say(words)
  }
  units()
  const element = h(
    'div',
    { id: 'time' },
    h(
      'div',
      { class: 'bar' },
      h('h2', {}, 'Time simulation'),
      h('span', { class: 'spring' }),
      csvButton('Simulation', () => playback.csv()),
      figureButtons(
        () => 'simulation',
        'Simulation',
        () => playback.figure(),
      ),
    ),
    h('p', { class: 'hint' }, 'The complete non-linear machine on a moving base, from rest at the pose.'),
    h(
      'div',
      { class: 'bar tools' },
      kind.element,
      axis.element,
      ...Object.values(fields).map((f) => f.element),
      csvField,
      button('Simulate', () => void run(), { class: 'primary', id: 'simulate' }),
    ),
    runner.element,
    playback.element,
  )
  return element
}

class Playback {
  readonly element: HTMLElement
  private readonly plots = [0, 1, 2].map(
    () =>
      new LinePlot(
        () => 200,
        (x) => this.seek(x),
        'time',
      ),
  )
  private readonly scrub = h('input', {
    type: 'range',
    min: 0,
    max: 1,
    step: 'any',
    value: 0,
    'aria-label': 'Time of the playback',
  })
  private readonly words = h('output', { class: 'now' })
  private readonly toggle = button('Pause', () => this.turn(!this.playing), {})
  private readonly speed = select(
    'Speed',
    [
      ['0.25', '¼ speed'],
      ['1', 'speed 1'],
      ['4', 'speed 4'],
    ] as const,
    '1',
    () => undefined,
  )
  private run: Run | null = null
  private playing = false
  private at = 0
  private last = 0

  constructor(private readonly animation: Animation) {
    this.scrub.addEventListener('input', () => this.seek(Number(this.scrub.value) * this.end))
    this.element = h(
      'div',
      { hidden: true },
      h('div', { class: 'bar tools' }, this.toggle, this.speed.element, this.scrub, this.words),
      ...this.plots.map((p) => p.element),
    )
    store.on(['tab'], () => page.tab !== 'time' && this.turn(false))
    store.on(['pose', 'text', 'changes'], () => this.leave())
    onTheme(() => {
      if (this.run) this.draw(this.run)
      this.plots.forEach((p) => p.build())
    })
  }

  private get end(): number {
    return this.run ? this.run.rows[(this.run.count - 1) * COLUMNS] : 0
  }

  take(run: Run): void {
    this.run = run
    this.element.hidden = false
    this.draw(run)
    this.at = 0
    store.set({ mode: -1 })
    this.turn(true)
  }

  private draw(run: Run): void {
    const column = (c: number, factor = 1) =>
      Float64Array.from({ length: run.count }, (_, i) => run.rows[i * COLUMNS + c] * factor)
    const t = column(0)
    const x = { label: 'time, s', min: 0, max: t[t.length - 1] }
    const sets: [string, string, string[], Float64Array[]][] = [
      [
        'Displacement from rest',
        'displacement, mm',
        ['x', 'y', 'z', 'base x', 'base y', 'base z'],
        [1, 2, 3, 7, 8, 9].map((c) => column(c, 1e3)),
      ],
      [
        'Rotation from rest',
        'rotation, mrad',
        ['roll', 'pitch', 'yaw', 'base roll', 'base pitch', 'base yaw'],
        [4, 5, 6, 10, 11, 12].map((c) => column(c, 1e3)),
      ],
      [
        'Leg forces',
        'force, N',
        ['leg 1', 'leg 2', 'leg 3', 'leg 4', 'leg 5', 'leg 6'],
        [19, 20, 21, 22, 23, 24].map((c) => column(c)),
      ],
    ]
    sets.forEach(([title, label, names, values], i) => {
      const [min, max] = span(values, false, 0, 1e-6) // a nanometre: what rounding leaves looks like nothing
      const colours = i < 2 ? [0, 1, 2, 0, 1, 2] : [0, 1, 2, 3, 4, 5]
      const series = names.map((name, k) => ({
        name,
        colour: categories()[colours[k]],
        dash: DASHES[k],
        values: values[k],
      }))
      this.plots[i].show({ title, x, y: { label, min, max }, at: t, series, marks: [] })
    })
  }

  private turn(on: boolean): void {
    this.playing = on
    this.toggle.textContent = on ? 'Pause' : 'Play'
    this.last = performance.now()
    if (on && this.at >= this.end) this.at = 0
    if (on) this.animation.play('time', () => this.step())
    else if (page.tab !== 'time') this.animation.stop('time')
  }

  /** The machine is another one, or elsewhere: what was simulated does not move it. */
  private leave(): void {
    if (!this.run) return
    this.turn(false)
    this.animation.stop('time')
  }

  private step(): ReturnType<typeof this.twists> {
    const now = performance.now()
    if (this.playing && this.run) {
      this.at += ((now - this.last) / 1000) * this.run.speed * Number(this.speed.element.value)
      if (this.at > this.end) this.at = this.end > 0 ? this.at % this.end : 0
    }
    this.last = now
    this.show()
    return this.twists()
  }

  private seek(seconds: number): void {
    this.at = Math.min(Math.max(seconds, 0), this.end)
    this.turn(false)
    this.animation.play('time', () => this.step())
  }

  private show(): void {
    if (!this.run) return
    this.scrub.value = String(this.end ? this.at / this.end : 0)
    this.words.textContent = `${sig(this.at, 4)} s, drawn ${sig(this.run.factor, 3)} × larger`
    for (const plot of this.plots) plot.playhead(this.at)
  }

  private twists() {
    const { rows, count, factor } = this.run!
    let [low, high] = [0, count - 1]
    while (high - low > 1) {
      const middle = (low + high) >> 1
      if (rows[middle * COLUMNS] <= this.at) low = middle
      else high = middle
    }
    const [a, b] = [low * COLUMNS, high * COLUMNS]
    const share = rows[b] > rows[a] ? (this.at - rows[a]) / (rows[b] - rows[a]) : 0
    const mixed = (from: number) =>
      Array.from({ length: 6 }, (_, i) => rows[a + from + i] + share * (rows[b + from + i] - rows[a + from + i]))
    return [twist(mixed(1), factor), twist(mixed(7), factor)] as [ReturnType<typeof twist>, ReturnType<typeof twist>]
  }

  csv(): void {
    if (!this.run) return
    const { rows, count } = this.run
    const six = (name: string, units: [string, string]) =>
      COORDINATES.map((c, i) => `${name}_${c}_${units[i < 3 ? 0 : 1]}`)
    const legs = (name: string) => [1, 2, 3, 4, 5, 6].map((n) => `leg_${n}_${name}`)
    const head = [
      'time_s',
      ...six('platform', ['m', 'rad']),
      ...six('base', ['m', 'rad']),
      ...legs('length_m'),
      ...legs('force_n'),
    ]
    saveCsv(
      'simulation',
      head,
      Array.from({ length: count }, (_, i) => Array.from(rows.subarray(i * COLUMNS, (i + 1) * COLUMNS))),
    )
  }

  figure(): SVGSVGElement {
    const figures = this.plots.map((p) => p.figure())
    const whole = figures[0].cloneNode(false) as SVGSVGElement
    whole.setAttribute('viewBox', '0 0 760 1380')
    whole.setAttribute('height', '1380')
    figures.forEach((figure, i) => {
      figure.setAttribute('y', String(460 * i))
      whole.append(figure)
    })
    return whole
  }
}
