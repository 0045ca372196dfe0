// A slice through the workspace at the pose, as a heat map over two coordinates. A click moves the machine.

import { type Grid, Heatmap } from '../charts/heatmap'
import { type Scale, valueAt } from '../charts/scale'
import { onTheme } from '../charts/theme'
import { COORDINATES, type Coordinate } from '../state/answers'
import { floats } from '../state/api'
import { page, store } from '../state/store'
import { h, select, settled } from '../widgets/dom'
import { csvButton, figureButtons, saveCsv } from '../widgets/download'
import { count } from '../widgets/format'
import { Runner } from '../widgets/job'
import { titleBar, toolBar } from '../widgets/layout'
import { setPose } from './pose'
import { unitOf } from './pose-box'

const SIDE = 120 // poses along each coordinate
const QUANTITIES = [
  ['0', 'index ω₁'],
  ['1', 'cond(H)'],
] as const
const NAMES = COORDINATES.map((c) => [c, c] as const)
const DONE = `${count(SIDE ** 2)} poses; the other four coordinates are the machine's. Paler: beyond the limits.`

function scaleOf(i: number): Scale {
  return { label: `${COORDINATES[i]}, ${unitOf(i)}`, min: page.box.low[i], max: page.box.high[i] }
}

function table({ side, x, y, values }: Grid): number[][] {
  return Array.from({ length: side ** 2 }, (_, i) => {
    const place = [valueAt(x, (i % side) / (side - 1)), valueAt(y, Math.floor(i / side) / (side - 1))]
    return [...place, ...values.subarray(3 * i, 3 * i + 3)]
  })
}

export class SlicePart {
  readonly element: HTMLElement
  private readonly heat = new Heatmap((x, y) => this.move(x, y))
  private readonly runner = new Runner()
  private readonly across = select('Coordinate across', NAMES, 'x', () => void this.run())
  private readonly up = select('Coordinate up', NAMES, 'y', () => void this.run())
  private readonly quantity = select('Quantity', QUANTITIES, '0', () => this.show(this.heat.shown))
  private drawn = { across: 0, up: 1 } // coordinates of the map shown
  private moved = false // by a click in this map, which then stays valid

  constructor() {
    const again = settled(250, () => this.element.offsetParent && void this.run())
    store.on(['pose'], () => {
      this.mark()
      if (this.moved) this.moved = false
      else if (this.heat.shown) again()
    })
    onTheme(this.heat.draw)
    const tools = [this.quantity.element, h('span', {}, 'over'), this.across.element, h('span', {}, 'and')]
    const figures = figureButtons(
      () => 'slice',
      'Slice',
      () => this.heat.figure(),
    )
    this.element = h(
      'section',
      { 'aria-label': 'Slice of the workspace', class: 'card', id: 'slice' },
      titleBar(
        'h3',
        'Slice at the pose',
        csvButton('Slice', () => this.csv()),
        figures,
      ),
      toolBar(...tools, this.up.element),
      this.runner.element,
      this.heat.element,
    )
  }

  async run(): Promise<void> {
    const names = { across: this.across.element.value, up: this.up.element.value }
    const [across, up] = [names.across, names.up].map((name) => COORDINATES.indexOf(name as Coordinate))
    const values = new Float32Array(3 * SIDE * SIDE).fill(Number.NaN)
    const grid: Grid = { side: SIDE, x: scaleOf(across), y: scaleOf(up), values }
    let at = 0
    const spec = { ...store.question(), box: page.box, ...names, side: SIDE }
    const whole = await this.runner.run('slice', spec, (message, data) => {
      if (message.type !== 'rows') return
      const part = floats(data)
      values.set(part, at)
      at += part.length
      this.drawn = { across, up }
      this.show(grid)
      this.mark()
    })
    if (whole) this.runner.say(DONE)
  }

  private show(grid: Grid | null): void {
    if (grid) this.heat.show(grid, Number(this.quantity.element.value))
  }

  private mark(): void {
    this.heat.mark(page.pose[this.drawn.across], page.pose[this.drawn.up])
  }

  private move(x: number, y: number): void {
    const pose = [...page.pose]
    pose[this.drawn.across] = Number(x.toPrecision(6))
    pose[this.drawn.up] = Number(y.toPrecision(6))
    this.moved = true
    setPose(pose)
  }

  private csv(): void {
    const grid = this.heat.shown
    if (!grid) return
    const places = [COORDINATES[this.drawn.across], COORDINATES[this.drawn.up]]
    saveCsv('slice', [...places, 'index_rad_s', 'cond_h', 'within_limits'], table(grid))
  }
}
