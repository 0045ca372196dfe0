// A canvas of colours with axes drawn over it as SVG, and a tip beside the pointer.

import { h, svg } from '../widgets/dom'
import type { Box2, Look } from './axes'
import { theme } from './theme'

const MARGIN = { left: 64, top: 10, bottom: 44 } // px, for axes

export class CanvasPlot {
  readonly element: HTMLElement
  readonly tip = h('div', { class: 'tip', hidden: true })
  private readonly over = svg('svg')
  private size: [number, number] = [0, 0] // px, when it was last painted

  /** `right`: px beside the canvas, for the colour bar. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly right: number,
    draw: () => void,
  ) {
    this.element = h('div', { class: 'plot', tabindex: 0, role: 'img' }, canvas, this.over, this.tip)
    new ResizeObserver(draw).observe(this.element)
  }

  get visible(): boolean {
    return this.element.clientWidth > 0 && this.element.clientHeight > 0
  }

  /** Where the canvas lies, px. */
  box(): Box2 {
    const [across, down] = this.size
    const width = Math.max(50, across - MARGIN.left - this.right)
    const height = Math.max(50, down - MARGIN.top - MARGIN.bottom)
    return { left: MARGIN.left, top: MARGIN.top, width, height }
  }

  look(): Look {
    return { ...theme(), size: 11 }
  }

  /** Where a pointer is, px from the upper left corner of the canvas. */
  place(event: MouseEvent): [number, number] {
    const at = this.element.getBoundingClientRect()
    return [event.clientX - at.left - MARGIN.left, event.clientY - at.top - MARGIN.top]
  }

  /** Take the size of the element, before anything is painted for it. */
  measure(): void {
    this.size = [this.element.clientWidth, this.element.clientHeight]
  }

  /** The canvas lies by shares of the element, as the axes do: on paper too, where nothing is painted again. */
  paint(image: ImageData): void {
    const box = this.box()
    const [across, down] = this.size
    this.element.style.setProperty('--shape', `${across} / ${down}`)
    this.canvas.width = image.width
    this.canvas.height = image.height
    const share = (part: number, whole: number) => `${(100 * part) / whole}%`
    const [left, top] = [share(box.left, across), share(box.top, down)]
    const [width, height] = [share(box.width, across), share(box.height, down)]
    Object.assign(this.canvas.style, { left, top, width, height })
    this.canvas.getContext('2d')!.putImageData(image, 0, 0)
  }

  /** Draw the axes and what else lies over the canvas. */
  cover(parts: SVGElement[]): void {
    this.over.setAttribute('viewBox', `0 0 ${this.size.join(' ')}`)
    this.over.replaceChildren(...parts)
  }

  showTip(words: string, left: number, top: number): void {
    this.tip.textContent = words
    this.tip.style.left = `${Math.min(left, this.element.clientWidth - 230)}px`
    this.tip.style.top = `${Math.max(4, top)}px`
  }

  /** The plot as a figure for a file. */
  figure(parts: SVGElement[]): SVGSVGElement {
    const [width, height] = this.size
    const { left: x, top: y, ...size } = this.box()
    const figure = svg('svg', { xmlns: 'http://www.w3.org/2000/svg', viewBox: `0 0 ${width} ${height}`, width, height })
    const image = svg('image', { x, y, ...size, href: this.canvas.toDataURL(), preserveAspectRatio: 'none' })
    figure.append(svg('rect', { width, height, fill: this.look().paper }), image, ...parts)
    return figure
  }
}
