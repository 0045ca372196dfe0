// A slice of the workspace: index or cond(H) over two coordinates, the machine's pose as a cross, clicking moves it.

import { axes, bar, fraction, rangeWords, valueAt, type Box2, type Look, type Scale } from './chart'
import { cividis, css, theme } from './colours'
import { h, perFrame, svg } from '../widgets/dom'
import { sig } from '../widgets/format'

export interface Grid {
  side: number
  x: Scale
  y: Scale
  values: Float32Array // rows of index, cond(H), within limits; x fastest
}

export class Heat {
  readonly element = h('div', { class: 'plot', role: 'img', tabindex: 0 })
  private readonly canvas = h('canvas', { class: 'smooth' })
  private readonly over = svg('svg')
  private readonly tip = h('div', { class: 'tip', hidden: true })
  private grid: Grid | null = null
  private column = 0
  private scale: Scale = { label: '', min: 0, max: 1 }
  private here: [number, number] | null = null
  private cursor: [number, number] | null = null
  readonly draw = perFrame(() => this.paint())

  constructor(private readonly chosen: (x: number, y: number) => void) {
    this.element.append(this.canvas, this.over, this.tip)
    this.element.addEventListener('pointermove', (event) => this.hover(event))
    this.element.addEventListener('pointerleave', () => {
      this.cursor = null
      this.tip.hidden = true
    })
    this.element.addEventListener('click', (event) => {
      this.hover(event)
      if (this.cursor) this.chosen(...this.cursor)
    })
    this.element.addEventListener('keydown', (event) => this.key(event))
    new ResizeObserver(this.draw).observe(this.element)
  }

  show(grid: Grid, column: number): void {
    this.grid = grid
    this.column = column
    this.draw()
  }

  mark(x: number, y: number): void {
    this.here = [x, y]
    this.draw()
  }

  private box(): Box2 {
    const { clientWidth: width, clientHeight: height } = this.element
    return { left: 64, top: 10, width: Math.max(50, width - 64 - 90), height: Math.max(50, height - 10 - 44) }
  }

  private range(grid: Grid): void {
    let [low, high] = [Infinity, -Infinity]
    for (let i = this.column; i < grid.values.length; i += 3) {
      const v = grid.values[i]
      if (v < low) low = v
      if (v > high && v < 1e9) high = v
    }
    const log = this.column === 1
    if (!(high > low)) high = low * 1.01 + 1e-12
    this.scale = { label: log ? 'cond(H)' : 'index ω₁, rad/s', min: log ? Math.max(low, 1) : low, max: high, log }
  }

  private paint(): void {
    const { clientWidth: width, clientHeight: height } = this.element
    if (!width || !height || !this.grid) return
    this.range(this.grid)
    const box = this.box()
    const side = this.grid.side
    this.canvas.width = this.canvas.height = side
    Object.assign(this.canvas.style, {
      left: `${box.left}px`,
      top: `${box.top}px`,
      width: `${box.width}px`,
      height: `${box.height}px`,
    })
    const image = new ImageData(side, side)
    for (let j = 0; j < side; j++) {
      for (let i = 0; i < side; i++) {
        const at = 3 * (j * side + i)
        const v = this.grid.values[at + this.column]
        if (!Number.isFinite(v)) continue
        const [r, g, b] = this.colour(fraction(this.scale, v))
        const outside = this.grid.values[at + 2] === 0
        image.data.set([r, g, b, outside ? 90 : 255], 4 * ((side - 1 - j) * side + i))
      }
    }
    this.canvas.getContext('2d')!.putImageData(image, 0, 0)
    this.over.setAttribute('viewBox', `0 0 ${width} ${height}`)
    this.over.replaceChildren(...this.vectors(box, this.look()))
    this.element.setAttribute(
      'aria-label',
      `Heat map of ${this.scale.label}, ${sig(this.scale.min, 3)} to ${sig(this.scale.max, 3)}. ${rangeWords(this.grid.x, this.grid.y)}. Arrow keys move the machine.`,
    )
  }

  private colour(t: number): [number, number, number] {
    return cividis(this.column === 1 ? 1 - t : t)
  }

  private look(): Look {
    return { ...theme(), size: 11 }
  }

  private vectors(box: Box2, look: Look): SVGElement[] {
    const grid = this.grid!
    const column = {
      left: box.left + box.width + 14,
      top: box.top + box.height * 0.1,
      width: 12,
      height: box.height * 0.8,
    }
    const parts: SVGElement[] = [
      axes(box, grid.x, grid.y, look),
      bar(column, this.scale, (t) => css(this.colour(t)), look),
    ]
    if (this.here) {
      const [tx, ty] = [fraction(grid.x, this.here[0]), 1 - fraction(grid.y, this.here[1])]
      if (tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1) {
        const d = `M${box.left + tx * box.width - 8} ${box.top + ty * box.height}h16m-8 -8v16`
        parts.push(
          svg('path', { d, stroke: '#ffffff', 'stroke-width': 5 }),
          svg('path', { d, stroke: '#d55e00', 'stroke-width': 2.5 }),
        )
      }
    }
    return parts
  }

  private hover(event: PointerEvent | MouseEvent): void {
    if (!this.grid) return
    const at = this.element.getBoundingClientRect()
    const box = this.box()
    const [tx, ty] = [
      (event.clientX - at.left - box.left) / box.width,
      1 - (event.clientY - at.top - box.top) / box.height,
    ]
    const inside = tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1
    this.cursor = inside ? [valueAt(this.grid.x, tx), valueAt(this.grid.y, ty)] : null
    this.tip.hidden = !inside
    this.element.classList.toggle('over', inside)
    if (!inside) return
    const side = this.grid.side
    const place = 3 * (Math.round(ty * (side - 1)) * side + Math.round(tx * (side - 1)))
    const [index, condition, within] = this.grid.values.subarray(place, place + 3)
    this.tip.textContent = `ω₁ ${sig(index)} rad/s   cond(H) ${sig(condition)}\n${this.grid.x.label} ${sig(this.cursor![0], 4)}   ${this.grid.y.label} ${sig(this.cursor![1], 4)}${within ? '' : '\nbeyond the limits'}`
    this.tip.style.left = `${Math.min(event.clientX - at.left + 14, this.element.clientWidth - 230)}px`
    this.tip.style.top = `${Math.max(4, event.clientY - at.top - 70)}px`
  }

  private key(event: KeyboardEvent): void {
    const way = (
      { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] } as Record<string, number[]>
    )[event.key]
    if (!way || !this.grid || !this.here) return
    event.preventDefault()
    const step = (s: Scale, v: number, w: number) => Math.min(Math.max(v + (w * (s.max - s.min)) / 100, s.min), s.max)
    this.chosen(step(this.grid.x, this.here[0], way[0]), step(this.grid.y, this.here[1], way[1]))
  }

  get shown(): Grid | null {
    return this.grid
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
      preserveAspectRatio: 'none',
    })
    figure.append(svg('rect', { width, height, fill: look.paper }), image, ...this.vectors(box, look))
    return figure
  }
}
