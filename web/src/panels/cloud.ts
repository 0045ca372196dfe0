// The cloud of random poses, index against cond(H), and the worst pose of the box. A click moves the machine.

import { Scatter } from '../charts/scatter'
import { onTheme } from '../charts/theme'
import { floats } from '../state/api'
import { page, store } from '../state/store'
import { button, freshId, h, select } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { count, duration, parsed, sig } from '../widgets/format'
import { Runner } from '../widgets/job'
import { dataTable, row, titleBar, toolBar } from '../widgets/layout'
import { setPose } from './pose'

const CSV_HEAD = ['x_m', 'y_m', 'z_m', 'roll_deg', 'pitch_deg', 'yaw_deg', 'index_rad_s', 'cond_h']
const COUNTS = [10_000, 100_000, 300_000, 1_000_000].map((n) => [String(n), `${count(n)} poses`] as const)
const SCALES = [
  ['linear', 'linear'],
  ['log', 'logarithmic'],
] as const
const SHARES: [string, number][] = [
  ['lowest', 0],
  ['5 %', 0.05],
  ['median', 0.5],
  ['95 %', 0.95],
  ['highest', 1],
]
const COLUMNS = [{ name: 'index' }, { name: 'ω₁ rad/s' }, { name: 'cond(H)' }, { name: '' }]

/** Poses are sent as float32, which nine digits represent exactly. */
const rounded = (six: number[]) => six.map((v) => Number(v.toPrecision(9)))

export class CloudPart {
  readonly element: HTMLElement
  private readonly scatter = new Scatter((point) => setPose(rounded(point.six)))
  private readonly runner = new Runner()
  private readonly summary = h('div', { class: 'scroll' })
  private readonly total = select('Number of poses', COUNTS, '100000', () => void this.run())
  private readonly scale = select('Axis of the index', SCALES, 'linear', (kind) => {
    this.scatter.logarithmic = kind === 'log'
  })
  private readonly seed = h('input', {
    type: 'text',
    class: 'number tiny',
    value: '1',
    inputmode: 'numeric',
    id: freshId('seed'),
  })

  constructor() {
    store.on(['snapshot'], () => this.scatter.mark(page.snapshot?.index ?? null, page.snapshot?.condition ?? null))
    onTheme(this.scatter.draw)
    this.seed.addEventListener('change', () => void this.run())
    const worst = worstPose()
    const csv = csvButton('Cloud', () => saveCsv('workspace', CSV_HEAD, this.scatter.rows()))
    const figures = figureButtons(
      () => 'workspace',
      'Cloud',
      () => this.scatter.figure(),
    )
    const seed = [h('label', { for: this.seed.id }, 'seed'), this.seed]
    const run = button('Run', () => void this.run())
    this.element = h(
      'section',
      { 'aria-label': 'Cloud of poses', class: 'card', id: 'cloud' },
      titleBar('h3', 'Index against cond(H)', csv, figures),
      toolBar(this.total.element, ...seed, this.scale.element, run, worst.button),
      this.runner.element,
      worst.element,
      this.scatter.element,
      this.summary,
    )
  }

  async run(): Promise<void> {
    const points = Number(this.total.element.value)
    const seed = Math.max(0, Math.round(parsed(this.seed.value)) || 0)
    const began = performance.now()
    this.scatter.begin(points)
    const spec = { ...store.question(), box: page.box, points, seed }
    const whole = await this.runner.run('cloud', spec, (message, data) => {
      if (message.type === 'points') this.scatter.add(floats(data))
    })
    const seconds = (performance.now() - began) / 1000
    if (whole) this.runner.say(`${count(this.scatter.size)} poses in ${duration(seconds)}`)
    if (this.scatter.size) this.summarise()
    this.element.dataset.points = String(this.scatter.size)
  }

  private summarise(): void {
    const order = this.scatter.order()
    const shares = order.length ? SHARES : []
    const rows = shares.map(([name, share]) => {
      const { six, index, condition } = this.scatter.point(order[Math.round(share * (order.length - 1))])
      const label = `Move the machine to the pose of the ${name} index`
      const go = button('Go', () => setPose(rounded(six)), { class: 'quiet', 'aria-label': label })
      return row(name, [sig(index), sig(condition), go])
    })
    this.summary.replaceChildren(
      dataTable('cloud-table', 'Poses of the cloud by index', COLUMNS, h('tbody', {}, ...rows)),
    )
  }
}

/** Finds the least index in the box and moves the machine there. */
function worstPose(): { button: HTMLElement; element: HTMLElement } {
  const runner = new Runner()
  const element = h('div', { id: 'worst', hidden: true }, runner.element)
  const find = () => {
    element.hidden = false
    void runner.run('worst', { ...store.question(), box: page.box }, (message) => {
      if (message.type !== 'found') return
      setPose(message.pose)
      setTimeout(() => runner.say(message.words))
    })
  }
  return { button: button('Worst pose', find, { title: 'Find the lowest index in the box and move there' }), element }
}
