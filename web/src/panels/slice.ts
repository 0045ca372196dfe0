// A slice through the workspace at the pose, as a heat map over two coordinates. A click moves the machine.

import { type Grid, Heatmap } from '../charts/heatmap'
import { type Scale, valueAt } from '../charts/scale'
import { onTheme } from '../charts/theme'
import { COORDINATES } from '../state/answers'
import { floats } from '../state/api'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { h } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { count } from '../widgets/format'
import { Runner } from '../widgets/job'
import { titleBar, toolBar } from '../widgets/layout'
import { Result } from '../widgets/result'
import { setPose } from './pose'
import { unitOf } from './pose-box'

const SIDE = 120 // poses along each coordinate
const QUANTITIES = [
  ['index', 'index ω₁'],
  ['condition', 'cond(H)'],
] as const
const NAMES = COORDINATES.map((c) => [c, c] as const)
const DONE = `${count(SIDE ** 2)} poses; the other four coordinates are the machine's.`
const GREY = ' Grey: beyond the limits.'

function scaleOf(i: number): Scale {
  return { label: `${COORDINATES[i]}, ${unitOf(i)}`, min: page.box.low[i], max: page.box.high[i] }
}

function table({ side, x, y, values }: Grid): number[][] {
  return Array.from({ length: side ** 2 }, (_, i) => {
    const place = [valueAt(x, (i % side) / (side - 1)), valueAt(y, Math.floor(i / side) / (side - 1))]
    return [...place, ...values.subarray(3 * i, 3 * i + 3)]
  })
}

/** The coordinates across and up do not count in the pose of a slice: a click in the map moves only these. */
function sliceQuestion() {
  const { across, up, box } = page
  const pose = page.pose.map((v, i) => (COORDINATES[i] === across || COORDINATES[i] === up ? box.low[i] : v))
  return { ...store.machine(), pose, box, across, up, side: SIDE }
}

export class SlicePart {
  readonly element: HTMLElement
  private readonly heat = new Heatmap((x, y) => this.move(x, y))
  private readonly runner = new Runner()
  private readonly result: Result
  private drawn = { across: 0, up: 1 } // coordinates of the map shown

  constructor() {
    const csv = csvButton('Slice', () => this.csv())
    const figures = figureButtons(
      () => 'slice',
      'Slice',
      () => this.heat.figure(),
    )
    this.result = new Result(
      { question: sliceQuestion, ask: () => void this.run(), live: true },
      [this.heat.element],
      [csv, figures],
    )
    store.on(['pose'], () => this.mark())
    store.on(['map', 'limits'], () => this.show(this.heat.shown))
    onTheme(this.heat.draw)
    const [across, up] = [choose('across', 'Coordinate across', NAMES), choose('up', 'Coordinate up', NAMES)]
    const tools = [choose('map', 'Quantity', QUANTITIES), h('span', {}, 'over'), across, h('span', {}, 'and'), up]
    this.element = h(
      'section',
      { 'aria-label': 'Slice of the workspace', class: 'card', id: 'slice' },
      titleBar('h3', 'Slice at the pose', csv, figures),
      toolBar(...tools),
      this.runner.element,
      this.result.framed(),
    )
  }

  private async run(): Promise<void> {
    const question = sliceQuestion()
    const [across, up] = [question.across, question.up].map((name) => COORDINATES.indexOf(name))
    const values = new Float32Array(3 * SIDE * SIDE).fill(Number.NaN)
    const grid: Grid = { side: SIDE, x: scaleOf(across), y: scaleOf(up), values }
    let at = 0
    const whole = await this.runner.run('slice', question, (message, data) => {
      if (message.type !== 'rows') return
      const part = floats(data)
      values.set(part, at)
      at += part.length
      this.drawn = { across, up }
      this.result.shows(question)
      this.show(grid)
      this.mark()
    })
    if (whole) this.runner.say(DONE + (grid.values.some((v, i) => i % 3 === 2 && v === 0) ? GREY : ''))
  }

  private show(grid: Grid | null): void {
    if (grid) this.heat.show(grid, page.map === 'condition' ? 1 : 0, page.limits === 'all')
  }

  private mark(): void {
    this.heat.mark(page.pose[this.drawn.across], page.pose[this.drawn.up])
  }

  private move(x: number, y: number): void {
    const pose = [...page.pose]
    pose[this.drawn.across] = Number(x.toPrecision(6))
    pose[this.drawn.up] = Number(y.toPrecision(6))
    setPose(pose)
  }

  private csv(): void {
    const grid = this.heat.shown
    if (!grid) return
    const places = [COORDINATES[this.drawn.across], COORDINATES[this.drawn.up]]
    saveCsv('slice', [...places, 'index_rad_s', 'cond_h', 'within_limits'], table(grid))
  }
}
