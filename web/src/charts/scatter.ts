// The scatter of index against cond(H): any number of points, shaded by how many fall on a pixel.

import { h, perFrame, svg } from '../widgets/dom'
import { count, sig } from '../widgets/format'
import { axes, bar } from './axes'
import { CanvasPlot } from './canvas-plot'
import { CloudPoints, type Point } from './cloud-points'
import { css, type Rgb, viridis } from './colourmaps'
import { Density, type Frame, shaded } from './density'
import { fraction, rangeWords, type Scale } from './scale'
import { beyond, theme } from './theme'

type Place = Pick<Point, 'index' | 'condition'>

const STEPS: Record<string, number> = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  PageUp: 100,
  PageDown: -100,
}

export class Scatter {
  readonly draw = perFrame(() => this.paint())
  private readonly plot = new CanvasPlot(h('canvas'), 84, this.draw)
  readonly element = this.plot.element
  private readonly density = new Density()
  private readonly points = new CloudPoints()
  private x: Scale = { label: 'cond(H)', min: 1, max: 10, log: true }
  private y: Scale = { label: 'index ω₁, rad/s', min: 0, max: 1, log: false }
  private most = 1 // points on a pixel
  private picked = -1
  private here: Place | null = null
  private everywhere = false

  constructor(private readonly chosen: (point: Point) => void) {
    this.element.addEventListener('pointermove', (event) => this.hover(event))
    this.element.addEventListener('pointerleave', () => this.pick(-1))
    this.element.addEventListener('click', (event) => {
      this.hover(event)
      if (this.picked >= 0) this.chosen(this.point(this.picked))
    })
    this.element.addEventListener('keydown', (event) => this.key(event))
  }

  /** Begin anew, for `total` points. */
  begin(total: number): void {
    this.points.begin(total)
    this.pick(-1)
  }

  add(part: Float32Array): void {
    if (this.points.add(part)) this.draw()
  }

  /** Whether the axis of the index is logarithmic. */
  set logarithmic(on: boolean) {
    this.y = { ...this.y, log: on, min: on ? 1e-3 : 0 }
    this.range()
    this.draw()
  }

  /** Whether poses beyond the limits count as well; otherwise they are grey. */
  set all(on: boolean) {
    this.everywhere = on
    this.draw()
  }

  /** How many poses are within the limits. */
  get within(): number {
    return this.points.within
  }

  /** The machine's own pose, drawn as a ring. */
  mark(index: number | null, condition: number | null): void {
    this.here = index === null || condition === null ? null : { index, condition }
    this.draw()
  }

  get size(): number {
    return this.points.count
  }

  point(i: number): Point {
    return this.points.at(i)
  }

  rows(): Generator<number[]> {
    return this.points.rows()
  }

  /** Places of the points that count, sorted by index. */
  order(): Uint32Array {
    return this.points.order(this.everywhere)
  }

  private range(): void {
    ;[this.x, this.y] = this.points.ranged(this.x, this.y)
  }

  private frame(): Frame {
    return { x: this.x, y: this.y, box: this.plot.box() }
  }

  private paint(): void {
    if (!this.plot.visible) return
    this.plot.measure()
    this.range()
    const frame = this.frame()
    const ratio = Math.min(2, devicePixelRatio)
    const size: [number, number] = [Math.round(frame.box.width * ratio), Math.round(frame.box.height * ratio)]
    const counts = this.density.counts(this.points, frame, size, this.everywhere)
    this.most = counts.counted.reduce((most, n) => Math.max(most, n), 2)
    this.plot.paint(shaded(counts, this.most, size, colour, beyond()))
    this.plot.cover(this.vectors())
    const words = `Scatter of ${count(this.size)} poses. ${rangeWords(this.x, this.y)}.`
    const keys = 'Arrow keys step through poses by index, Enter moves the machine there.'
    this.element.setAttribute('aria-label', `${words} ${keys}`)
  }

  private vectors(): SVGElement[] {
    const [box, look] = [this.plot.box(), this.plot.look()]
    const density = { label: 'poses on a pixel', min: 1, max: this.most, log: true }
    const column = {
      left: box.left + box.width + 14,
      top: box.top + box.height * 0.2,
      width: 10,
      height: box.height * 0.6,
    }
    const key = bar(column, density, (t) => css(colour(t)), look)
    const rings = [
      ...this.ring(this.here, { stroke: look.paper, 'stroke-width': 6 }),
      ...this.ring(this.here, { stroke: '#d55e00' }),
      ...this.ring(this.picked < 0 ? null : this.point(this.picked), { stroke: look.text }),
    ]
    return [axes(box, this.x, this.y, look), key, ...rings]
  }

  private ring(place: Place | null, more: Record<string, unknown>): SVGElement[] {
    if (!place) return []
    const [tx, ty] = [fraction(this.x, place.condition), 1 - fraction(this.y, place.index)]
    if (tx < 0 || tx > 1 || ty < 0 || ty > 1) return []
    const box = this.plot.box()
    const centre = { cx: box.left + tx * box.width, cy: box.top + ty * box.height }
    return [svg('circle', { ...centre, r: 6, fill: 'none', 'stroke-width': 2.5, ...more })]
  }

  private hover(event: MouseEvent): void {
    this.pick(this.density.nearest(this.points, this.frame(), this.plot.place(event)))
  }

  private pick(i: number): void {
    if (i === this.picked) return
    this.picked = i
    this.plot.tip.hidden = i < 0
    this.element.classList.toggle('over', i >= 0)
    this.plot.cover(this.vectors())
    if (i < 0) return
    const p = this.point(i)
    const box = this.plot.box()
    const left = box.left + fraction(this.x, p.condition) * box.width
    const top = box.top + (1 - fraction(this.y, p.index)) * box.height
    this.plot.showTip(words(p), left + 14, top > 90 ? top - 76 : top + 16)
  }

  private key(event: KeyboardEvent): void {
    if (event.key === 'Enter' && this.picked >= 0) this.chosen(this.point(this.picked))
    const way = STEPS[event.key]
    if (!way || !this.size) return
    event.preventDefault()
    const order = this.order()
    const before = way > 0 ? -1 : order.length
    const at = this.picked < 0 ? before : order.indexOf(this.picked)
    this.pick(order[Math.min(Math.max(at + way, 0), order.length - 1)])
  }

  figure(): SVGSVGElement {
    return this.plot.figure(this.vectors())
  }
}

function colour(t: number): Rgb {
  return viridis(theme().dark ? 0.4 + 0.6 * t : 0.58 - 0.58 * t)
}

function words({ six, index, condition, within }: Point): string {
  const [x, y, z] = six.slice(0, 3).map((v) => sig(v, 4))
  const [roll, pitch, yaw] = six.slice(3).map((v) => sig(v, 3))
  const numbers = `ω₁ ${sig(index)} rad/s   cond(H) ${sig(condition)}`
  const state = within ? '' : '\nbeyond the limits'
  return `${numbers}\nx ${x}  y ${y}  z ${z} m\nroll ${roll}°  pitch ${pitch}°  yaw ${yaw}°${state}`
}
