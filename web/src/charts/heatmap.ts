// A slice of the workspace: index or cond(H) over two coordinates. A cross marks the machine's pose, a click moves it.

import { h, perFrame, svg } from '../widgets/dom'
import { sig } from '../widgets/format'
import { axes, type Box2, bar } from './axes'
import { CanvasPlot } from './canvas-plot'
import { cividis, css, type Rgb } from './colourmaps'
import { fraction, rangeWords, type Scale, valueAt } from './scale'
import { beyond } from './theme'

export interface Grid {
  side: number
  x: Scale
  y: Scale
  values: Float32Array // rows of index, cond(H), within limits; x fastest
}

const STEPS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
}

export class Heatmap {
  readonly draw = perFrame(() => this.paint())
  private readonly plot = new CanvasPlot(h('canvas', { class: 'smooth' }), 90, this.draw)
  readonly element = this.plot.element
  private grid: Grid | null = null
  private column = 0
  private everywhere = false // also poses beyond the limits have their colour; otherwise they are grey
  private scale: Scale = { label: '', min: 0, max: 1 }
  private here: [number, number] | null = null
  private cursor: [number, number] | null = null

  constructor(private readonly chosen: (x: number, y: number) => void) {
    this.element.addEventListener('pointermove', (event) => this.hover(event))
    this.element.addEventListener('pointerleave', () => {
      this.cursor = null
      this.plot.tip.hidden = true
    })
    this.element.addEventListener('click', (event) => {
      this.hover(event)
      if (this.cursor) this.chosen(...this.cursor)
    })
    this.element.addEventListener('keydown', (event) => this.key(event))
  }

  show(grid: Grid, column: number, everywhere: boolean): void {
    this.everywhere = everywhere
    this.grid = grid
    this.column = column
    this.draw()
  }

  get shown(): Grid | null {
    return this.grid
  }

  /** The machine's own pose, drawn as a cross. */
  mark(x: number, y: number): void {
    this.here = [x, y]
    this.draw()
  }

  /** Whether the pose whose values begin at a place counts: within the limits, or all do. */
  private counts({ values }: Grid, at: number): boolean {
    return this.everywhere || values[at + 2] !== 0
  }

  private range(grid: Grid): void {
    let [low, high] = [Infinity, -Infinity]
    for (let i = this.column; i < grid.values.length; i += 3) {
      const v = this.counts(grid, i - this.column) ? grid.values[i] : Number.NaN
      if (v < low) low = v
      if (v > high && v < 1e9) high = v
    }
    const log = this.column === 1
    if (low === Infinity) low = 1
    if (!(high > low)) high = low * 1.01 + 1e-12
    this.scale = { label: log ? 'cond(H)' : 'index ω₁, rad/s', min: log ? Math.max(low, 1) : low, max: high, log }
  }

  private paint(): void {
    if (!this.plot.visible || !this.grid) return
    this.plot.measure()
    this.range(this.grid)
    this.plot.paint(this.image(this.grid))
    this.plot.cover(this.vectors(this.grid))
    const { label, min, max } = this.scale
    const words = `Heat map of ${label}, ${sig(min, 3)} to ${sig(max, 3)}. ${rangeWords(this.grid.x, this.grid.y)}.`
    this.element.setAttribute('aria-label', `${words} Arrow keys move the machine.`)
  }

  private image(grid: Grid): ImageData {
    const { side, values } = grid
    const image = new ImageData(side, side)
    for (let j = 0; j < side; j++) {
      for (let i = 0; i < side; i++) {
        const at = 3 * (j * side + i)
        const v = values[at + this.column]
        if (!Number.isFinite(v)) continue
        const rgb = this.counts(grid, at) ? this.colour(fraction(this.scale, v)) : beyond()
        image.data.set([...rgb, 255], 4 * ((side - 1 - j) * side + i))
      }
    }
    return image
  }

  private colour(t: number): Rgb {
    return cividis(this.column === 1 ? 1 - t : t)
  }

  private vectors(grid: Grid): SVGElement[] {
    const [box, look] = [this.plot.box(), this.plot.look()]
    const { left, top, width, height } = box
    const column = { left: left + width + 14, top: top + height * 0.1, width: 12, height: height * 0.8 }
    const key = bar(column, this.scale, (t) => css(this.colour(t)), look)
    return [axes(box, grid.x, grid.y, look), key, ...this.cross(grid, box)]
  }

  private cross(grid: Grid, box: Box2): SVGElement[] {
    if (!this.here) return []
    const [tx, ty] = [fraction(grid.x, this.here[0]), 1 - fraction(grid.y, this.here[1])]
    if (!(tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1)) return []
    const d = `M${box.left + tx * box.width - 8} ${box.top + ty * box.height}h16m-8 -8v16`
    const halo = svg('path', { d, stroke: '#ffffff', 'stroke-width': 5 })
    return [halo, svg('path', { d, stroke: '#d55e00', 'stroke-width': 2.5 })]
  }

  private hover(event: MouseEvent): void {
    if (!this.grid) return
    const box = this.plot.box()
    const [px, py] = this.plot.place(event)
    const [tx, ty] = [px / box.width, 1 - py / box.height]
    const inside = tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1
    this.cursor = inside ? [valueAt(this.grid.x, tx), valueAt(this.grid.y, ty)] : null
    this.plot.tip.hidden = !inside
    this.element.classList.toggle('over', inside)
    if (inside) this.plot.showTip(this.words(this.grid, tx, ty), px + box.left + 14, py + box.top - 70)
  }

  private words({ side, x, y, values }: Grid, tx: number, ty: number): string {
    const place = 3 * (Math.round(ty * (side - 1)) * side + Math.round(tx * (side - 1)))
    const [index, condition, within] = values.subarray(place, place + 3)
    const numbers = `ω₁ ${sig(index)} rad/s   cond(H) ${sig(condition)}`
    const at = `${x.label} ${sig(valueAt(x, tx), 4)}   ${y.label} ${sig(valueAt(y, ty), 4)}`
    return `${numbers}\n${at}${within ? '' : '\nbeyond the limits'}`
  }

  private key(event: KeyboardEvent): void {
    const way = STEPS[event.key]
    if (!way || !this.grid || !this.here) return
    event.preventDefault()
    const step = (s: Scale, v: number, w: number) => Math.min(Math.max(v + (w * (s.max - s.min)) / 100, s.min), s.max)
    this.chosen(step(this.grid.x, this.here[0], way[0]), step(this.grid.y, this.here[1], way[1]))
  }

  figure(): SVGSVGElement {
    return this.plot.figure(this.vectors(this.grid!))
  }
}
