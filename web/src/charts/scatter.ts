// The scatter of index against cond(H): any number of points, shaded by how many fall on a pixel.

import { axes, bar, fraction, rangeWords, type Box2, type Look, type Scale } from './chart'
import { css, theme, viridis } from './colours'
import { h, perFrame, svg } from '../widgets/dom'
import { count, sig } from '../widgets/format'

export const WIDTH = 8 // numbers of one point: x y z roll pitch yaw index cond(H)
const CELL = 6 // px of the grid in which the nearest point is looked up

interface Picked {
  six: number[]
  index: number
  condition: number
}

export class Cloud {
  readonly element = h('div', { class: 'plot', tabindex: 0, role: 'img' })
  private readonly canvas = h('canvas')
  private readonly over = svg('svg')
  private readonly tip = h('div', { class: 'tip', hidden: true })
  private data = new Float32Array(0)
  private filled = 0
  private x: Scale = { label: 'cond(H)', min: 1, max: 10, log: true }
  private y: Scale = { label: 'index ω₁, rad/s', min: 0, max: 1, log: false }
  private first = new Int32Array(0)
  private next = new Int32Array(0)
  private columns = 0
  private most = 1
  private picked = -1
  private here: { index: number; condition: number } | null = null
  readonly draw = perFrame(() => this.paint())

  constructor(private readonly chosen: (point: Picked) => void) {
    this.element.append(this.canvas, this.over, this.tip)
    this.element.addEventListener('pointermove', (event) => this.hover(event))
    this.element.addEventListener('pointerleave', () => this.leave())
    this.element.addEventListener('click', (event) => {
      this.hover(event)
      if (this.picked >= 0) this.chosen(this.point(this.picked))
    })
    this.element.addEventListener('keydown', (event) => this.key(event))
    new ResizeObserver(this.draw).observe(this.element)
  }

  begin(total: number): void {
    this.data = new Float32Array(total * WIDTH)
    this.filled = 0
    this.leave()
  }

  add(part: Float32Array): void {
    if ((this.filled + part.length / WIDTH) * WIDTH > this.data.length) return
    this.data.set(part, this.filled * WIDTH)
    this.filled += part.length / WIDTH
    this.draw()
  }

  /** Whether the axis of the index is logarithmic. */
  set logarithmic(on: boolean) {
    this.y = { ...this.y, log: on, min: on ? 1e-3 : 0 }
    this.range()
    this.draw()
  }

  /** The machine's own pose, drawn as a ring. */
  mark(index: number | null, condition: number | null): void {
    this.here = index === null || condition === null ? null : { index, condition }
    this.draw()
  }

  get size(): number {
    return this.filled
  }

  point(i: number): Picked {
    const at = i * WIDTH
    return { six: Array.from(this.data.subarray(at, at + 6)), index: this.data[at + 6], condition: this.data[at + 7] }
  }

  *rows(): Generator<number[]> {
    for (let i = 0; i < this.filled; i++) yield Array.from(this.data.subarray(i * WIDTH, (i + 1) * WIDTH))
  }

  /** The points sorted by index, as places in the cloud; those without one left out. */
  order(): Uint32Array {
    const places = new Uint32Array(this.filled)
      .map((_, i) => i)
      .filter((i) => Number.isFinite(this.data[i * WIDTH + 6]))
    return places.sort((a, b) => this.data[a * WIDTH + 6] - this.data[b * WIDTH + 6])
  }

  private box(): Box2 {
    const { clientWidth: width, clientHeight: height } = this.element
    return { left: 64, top: 10, width: Math.max(50, width - 64 - 84), height: Math.max(50, height - 10 - 44) }
  }

  private range(): void {
    let [low, high, top, least] = [Infinity, 0, 0, Infinity]
    for (let i = 0; i < this.filled; i++) {
      const condition = this.data[i * WIDTH + 7]
      const index = this.data[i * WIDTH + 6]
      if (condition < low) low = condition
      if (condition > high && condition < 1e9) high = condition
      if (index > top) top = index
      if (index < least && (index > 1e-9 || !this.y.log)) least = index
    }
    if (this.filled === 0 || low === Infinity) return
    this.x = { ...this.x, min: low / 1.05, max: Math.max(high * 1.05, low * 1.2) }
    if (this.y.log) {
      this.y = { ...this.y, min: least / 1.1, max: top * 1.1 }
      return
    }
    const room = 0.05 * (top - least)
    this.y = { ...this.y, min: least > 0.4 * top ? least - room : 0, max: top + room || 1 }
  }

  private paint(): void {
    const { clientWidth: width, clientHeight: height } = this.element
    if (!width || !height) return
    this.range()
    const box = this.box()
    const ratio = Math.min(2, devicePixelRatio)
    const [w, hgt] = [Math.round(box.width * ratio), Math.round(box.height * ratio)]
    this.canvas.width = w
    this.canvas.height = hgt
    Object.assign(this.canvas.style, {
      left: `${box.left}px`,
      top: `${box.top}px`,
      width: `${box.width}px`,
      height: `${box.height}px`,
    })
    this.canvas.getContext('2d')!.putImageData(this.shaded(w, hgt, box), 0, 0)
    const look = this.look()
    this.over.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.over.replaceChildren(...this.vectors(box, look))
    this.element.setAttribute(
      'aria-label',
      `Scatter of ${count(this.filled)} poses. ${rangeWords(this.x, this.y)}. Arrow keys step through poses by index, Enter moves the machine there.`,
    )
  }

  private look(): Look {
    return { ...theme(), size: 11 }
  }

  private colour(t: number): [number, number, number] {
    return viridis(theme().dark ? 0.3 + 0.7 * t : 0.72 - 0.72 * t)
  }

  /** Counts of points on pixels, as colours; the lookup grid for hovering is filled on the way. */
  private shaded(w: number, hgt: number, box: Box2): ImageData {
    const counts = new Uint32Array(w * hgt)
    this.columns = Math.ceil(box.width / CELL) + 1
    this.first = new Int32Array(this.columns * (Math.ceil(box.height / CELL) + 1)).fill(-1)
    if (this.next.length < this.filled) this.next = new Int32Array(this.data.length / WIDTH)
    const dot = this.filled > 400_000 ? 1 : 2
    const [x0, kx] = [Math.log(this.x.min), 1 / Math.log(this.x.max / this.x.min)]
    const log = this.y.log
    const y0 = log ? Math.log(this.y.min) : this.y.min
    const ky = 1 / ((log ? Math.log(this.y.max) : this.y.max) - y0)
    for (let i = 0; i < this.filled; i++) {
      const tx = (Math.log(this.data[i * WIDTH + 7]) - x0) * kx
      const index = this.data[i * WIDTH + 6]
      const ty = 1 - ((log ? Math.log(index) : index) - y0) * ky
      if (!(tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1)) continue
      const cell = Math.floor((tx * box.width) / CELL) + this.columns * Math.floor((ty * box.height) / CELL)
      this.next[i] = this.first[cell]
      this.first[cell] = i
      const px = Math.min(w - dot, Math.floor(tx * w))
      const py = Math.min(hgt - dot, Math.floor(ty * hgt))
      for (let a = 0; a < dot; a++) for (let b = 0; b < dot; b++) counts[(py + a) * w + px + b]++
    }
    this.most = counts.reduce((most, n) => (n > most ? n : most), 2)
    const image = new ImageData(w, hgt)
    const scale = 1 / Math.log(this.most)
    const palette = Array.from({ length: 257 }, (_, i) => this.colour(i / 256))
    for (let p = 0; p < counts.length; p++) {
      if (!counts[p]) continue
      const c = palette[Math.round(256 * Math.min(1, Math.log(counts[p]) * scale))]
      image.data.set([c[0], c[1], c[2], 255], 4 * p)
    }
    return image
  }

  private vectors(box: Box2, look: Look): SVGElement[] {
    const density = { label: 'poses on a pixel', min: 1, max: this.most, log: true }
    const column = {
      left: box.left + box.width + 14,
      top: box.top + box.height * 0.2,
      width: 10,
      height: box.height * 0.6,
    }
    const parts: SVGElement[] = [
      axes(box, this.x, this.y, look),
      bar(column, density, (t) => css(this.colour(t)), look),
    ]
    const circle = (index: number, condition: number, more: Record<string, unknown>) => {
      const [tx, ty] = [fraction(this.x, condition), 1 - fraction(this.y, index)]
      if (tx < 0 || tx > 1 || ty < 0 || ty > 1) return
      parts.push(
        svg('circle', {
          cx: box.left + tx * box.width,
          cy: box.top + ty * box.height,
          r: 6,
          fill: 'none',
          'stroke-width': 2.5,
          ...more,
        }),
      )
    }
    if (this.here) {
      circle(this.here.index, this.here.condition, { stroke: look.paper, 'stroke-width': 6 })
      circle(this.here.index, this.here.condition, { stroke: '#d55e00' })
    }
    if (this.picked >= 0)
      circle(this.data[this.picked * WIDTH + 6], this.data[this.picked * WIDTH + 7], { stroke: look.text })
    return parts
  }

  private hover(event: PointerEvent | MouseEvent): void {
    const at = this.element.getBoundingClientRect()
    const box = this.box()
    const [px, py] = [event.clientX - at.left - box.left, event.clientY - at.top - box.top]
    this.pick(this.nearest(px, py, box))
  }

  private nearest(px: number, py: number, box: Box2): number {
    const [cx, cy] = [Math.floor(px / CELL), Math.floor(py / CELL)]
    let [best, found] = [14 ** 2, -1]
    for (let gy = cy - 2; gy <= cy + 2; gy++) {
      for (let gx = cx - 2; gx <= cx + 2; gx++) {
        if (gx < 0 || gy < 0 || gx >= this.columns) continue
        for (let i = this.first[gy * this.columns + gx] ?? -1; i >= 0; i = this.next[i]) {
          const dx = fraction(this.x, this.data[i * WIDTH + 7]) * box.width - px
          const dy = (1 - fraction(this.y, this.data[i * WIDTH + 6])) * box.height - py
          const distance = dx * dx + dy * dy
          if (distance < best) [best, found] = [distance, i]
        }
      }
    }
    return found
  }

  private pick(i: number): void {
    if (i === this.picked) return
    this.picked = i
    this.tip.hidden = i < 0
    this.element.classList.toggle('over', i >= 0)
    const box = this.box()
    this.over.replaceChildren(...this.vectors(box, this.look()))
    if (i < 0) return
    const p = this.point(i)
    const words = `ω₁ ${sig(p.index)} rad/s   cond(H) ${sig(p.condition)}\nx ${sig(p.six[0], 4)}  y ${sig(p.six[1], 4)}  z ${sig(p.six[2], 4)} m\nroll ${sig(p.six[3], 3)}°  pitch ${sig(p.six[4], 3)}°  yaw ${sig(p.six[5], 3)}°`
    this.tip.textContent = words
    const tx = box.left + fraction(this.x, p.condition) * box.width
    const ty = box.top + (1 - fraction(this.y, p.index)) * box.height
    this.tip.style.left = `${Math.min(tx + 14, this.element.clientWidth - 230)}px`
    this.tip.style.top = `${Math.max(4, ty > 90 ? ty - 76 : ty + 16)}px`
  }

  private leave(): void {
    this.pick(-1)
  }

  private key(event: KeyboardEvent): void {
    if (event.key === 'Enter' && this.picked >= 0) this.chosen(this.point(this.picked))
    const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 100, PageDown: -100 }[event.key]
    if (!way || !this.filled) return
    event.preventDefault()
    const order = this.order()
    const at = this.picked < 0 ? (way > 0 ? -1 : order.length) : order.indexOf(this.picked)
    this.pick(order[Math.min(Math.max(at + way, 0), order.length - 1)])
  }

  figure(): SVGSVGElement {
    const { clientWidth: width, clientHeight: height } = this.element
    const box = this.box()
    const look = this.look()
    const figure = svg('svg', { xmlns: 'http://www.w3.org/2000/svg', viewBox: `0 0 ${width} ${height}`, width, height })
    const image = svg('image', {
      x: box.left,
      y: box.top,
      width: box.width,
      height: box.height,
      href: this.canvas.toDataURL(),
    })
    figure.append(svg('rect', { width, height, fill: look.paper }), image, ...this.vectors(box, look))
    return figure
  }
}
