// The cloud of random poses, index against cond(H), and the worst pose of the box. A click moves the machine.

import { Scatter } from '../charts/scatter'
import { onTheme } from '../charts/theme'
import { floats } from '../state/api'
import { page, store } from '../state/store'
import { choose, numberBox } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { count, duration, sig } from '../widgets/format'
import { Runner } from '../widgets/job'
import { dataTable, row, titleBar, toolBar } from '../widgets/layout'
import { Result } from '../widgets/result'
import { setPose } from './pose'

const CSV_HEAD = ['x_m', 'y_m', 'z_m', 'roll_deg', 'pitch_deg', 'yaw_deg', 'index_rad_s', 'cond_h', 'within_limits']
const COUNTS = (['10000', '100000', '300000', '1000000'] as const).map((n) => [n, `${count(Number(n))} poses`] as const)
const SCALES = [
  ['linear', 'linear'],
  ['log', 'logarithmic'],
] as const
const LIMITS = [
  ['within', 'poses within the limits count'],
  ['all', 'all poses count'],
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
  private seconds = 0
  private readonly summary = h('div', { class: 'scroll' })
  private readonly result: Result

  constructor() {
    const csv = csvButton('Cloud', () => saveCsv('workspace', CSV_HEAD, this.scatter.rows()))
    const figures = figureButtons(
      () => 'workspace',
      'Cloud',
      () => this.scatter.figure(),
    )
    this.result = new Result(
      { question: cloudQuestion, ask: () => void this.run(), live: true },
      [this.scatter.element, this.summary],
      [csv, figures],
    )
    store.on(['snapshot'], () => this.scatter.mark(page.snapshot?.index ?? null, page.snapshot?.condition ?? null))
    store.on(['scale'], () => {
      this.scatter.logarithmic = page.scale === 'log'
    })
    store.on(['limits'], () => {
      this.scatter.all = page.limits === 'all'
      this.tell()
    })
    onTheme(this.scatter.draw)
    const worst = worstPose()
    this.element = h(
      'section',
      { 'aria-label': 'Cloud of poses', class: 'card', id: 'cloud' },
      titleBar('h3', 'Index against cond(H)', csv, figures),
      this.tools(worst.button),
      this.runner.element,
      worst.element,
      this.result.framed(),
    )
  }

  private tools(worst: HTMLElement): HTMLElement {
    const total = choose('points', 'Number of poses', COUNTS)
    const seed = numberBox('seed', 'Seed of the random poses', { class: 'number tiny', inputmode: 'numeric' })
    const scale = choose('scale', 'Axis of the index', SCALES)
    const run = button('Run', () => this.result.ask())
    return toolBar(
      total,
      h('span', {}, 'seed'),
      seed.input,
      seed.wrong,
      scale,
      choose('limits', 'Which poses count', LIMITS),
      run,
      worst,
    )
  }

  private async run(): Promise<void> {
    const question = cloudQuestion()
    const began = performance.now()
    this.scatter.begin(question.points)
    this.result.shows(question)
    const whole = await this.runner.run('cloud', question, (message, data) => {
      if (message.type === 'points') this.scatter.add(floats(data))
    })
    this.seconds = (performance.now() - began) / 1000
    if (whole) this.tell()
    else if (this.scatter.size) this.summarise()
    this.element.dataset.points = String(this.scatter.size)
  }

  /** How many poses, and which share of them is within the limits. */
  private tell(): void {
    const { size, within } = this.scatter
    if (!size) return
    const others = within === size ? '' : page.limits === 'all' ? ', and all count' : ', the others are grey'
    const share = page.snapshot?.limits.any ? `; ${sig((100 * within) / size, 3)} % within the limits${others}` : ''
    this.runner.say(`${count(size)} poses in ${duration(this.seconds)}${share}`)
    this.summarise()
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

function cloudQuestion() {
  return { ...store.machine(), box: page.box, points: Number(page.points), seed: Math.round(page.seed) }
}

/** Finds the least index in the box and moves the machine there. */
function worstPose(): { button: HTMLElement; element: HTMLElement } {
  const runner = new Runner()
  const question = () => ({ ...store.machine(), box: page.box, all_poses: page.limits === 'all' })
  const find = () => {
    const asked = question()
    element.hidden = false
    void runner.run('worst', asked, (message) => {
      if (message.type !== 'found') return
      setPose(message.pose)
      result.shows(asked)
      setTimeout(() => runner.say(message.words))
    })
  }
  const again = 'find the worst pose again'
  const result = new Result({ question, ask: find, live: false, again }, [runner.element])
  const element = h('div', { id: 'worst', hidden: true }, result.framed())
  return {
    button: button('Worst pose', find, {
      title: 'Find the lowest index in the box, of the poses that count, and move there',
    }),
    element,
  }
}
