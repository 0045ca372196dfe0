// Lines over x on the page (uPlot), redrawn in the theme's colours, and the same as a figure for files.

import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { h } from '../widgets/dom'
import { sig } from '../widgets/format'
import { type Lines, lineFigure, type Series } from './line-figure'
import type { Theme } from './look'
import { onPrint } from './printing'
import { type Scale, ticks, tickText } from './scale'
import { theme } from './theme'

export class LinePlot {
  readonly element = h('figure', { class: 'lines', role: 'group' })
  private plot: uPlot | null = null
  private shown: Lines | null = null
  private hidden = new Set<string>()
  private head: HTMLElement | null = null
  private readonly tip = h('div', { class: 'tip', hidden: true })

  constructor(
    private readonly height: () => number,
    private readonly clicked: ((x: number) => void) | null = null,
    private readonly sync = '',
  ) {
    new ResizeObserver(() => this.fit()).observe(this.element)
    onPrint(
      () => this.shown && this.element.append(h('div', { class: 'printed' }, this.figure())),
      () => this.element.querySelector('.printed')?.remove(),
    )
  }

  show(lines: Lines): void {
    const { plot, shown } = this
    this.shown = lines
    if (plot && shown && alike(shown, lines)) {
      plot.setData(this.data(lines), false)
      plot.batch(() => {
        plot.setScale('x', { min: lines.x.min, max: lines.x.max })
        plot.setScale('y', { min: lines.y.min, max: lines.y.max })
      })
    } else this.build()
  }

  /** Draw again, for instance in another theme. */
  readonly build = (): void => {
    this.plot?.destroy()
    this.plot = null
    const lines = this.shown
    if (!lines || this.element.clientWidth < 40) return
    this.element.setAttribute('aria-label', `${lines.title}: ${lines.y.label} over ${lines.x.label}`)
    this.plot = new uPlot(this.options(lines), this.data(lines), this.element)
    this.head = h('div', { class: 'playhead', hidden: true })
    this.plot.over.append(this.head, this.tip)
    this.tip.hidden = true
    if (this.clicked) {
      this.plot.over.classList.add('pickable')
      this.plot.over.addEventListener('click', () => {
        const left = this.plot?.cursor.left ?? -1
        if (left >= 0) this.clicked!(this.plot!.posToVal(left, 'x'))
      })
    }
  }

  private data(lines: Lines): uPlot.AlignedData {
    const safe = (values: ArrayLike<number | null>) =>
      lines.y.log
        ? Array.from(values, (v) => (v !== null && v > 0 && Number.isFinite(v) ? v : null))
        : Array.from(values, (v) => (v !== null && Number.isFinite(v) ? v : null))
    return [Array.from(lines.at), ...lines.series.map((s) => safe(s.values))] as uPlot.AlignedData
  }

  private options(lines: Lines): uPlot.Options {
    const t = theme()
    const { clientWidth: width } = this.element
    return {
      width,
      height: this.height(),
      padding: [8, 24, 0, 0],
      cursor: { drag: { x: true, y: false }, points: { size: 6 }, ...(this.sync ? { sync: { key: this.sync } } : {}) },
      legend: { show: false },
      scales: scales(() => this.shown ?? lines),
      axes: [
        { ...axis(lines.x, Math.max(2, width / 90), t), size: 26 },
        { ...axis(lines.y, Math.max(2, this.height() / 45), t), size: 58 },
      ],
      series: [
        { label: lines.x.label, value: (_u, v) => sig(v, 4) },
        ...lines.series.map((s) => line(s, !this.hidden.has(s.name))),
      ],
      hooks: {
        draw: [(u) => this.marks(u, lines, t.muted)],
        setCursor: [(u) => this.tell(u)],
      },
    }
  }

  /** The values at the cursor, beside it; only in the plot under the pointer. */
  private tell({ cursor, data, series, over }: uPlot): void {
    const lines = this.shown
    const at = cursor.idx
    this.tip.hidden = !lines || at === null || at === undefined || !over.matches(':hover')
    if (this.tip.hidden || !lines) return
    const rows = lines.series.filter((_, i) => series[i + 1].show)
    const values = rows.map((line) => `${line.name}  ${sig(line.values[at!], 4)}`)
    this.tip.textContent = [`${lines.x.label}  ${sig(data[0][at!], 5)}`, ...values].join('\n')
    const [left, width] = [cursor.left ?? 0, over.clientWidth]
    this.tip.style.left = left < width / 2 ? `${left + 14}px` : 'auto'
    this.tip.style.right = left < width / 2 ? 'auto' : `${width - left + 14}px`
    this.tip.style.top = '4px'
  }

  private marks(u: uPlot, lines: Lines, colour: string): void {
    const c = u.ctx
    c.save()
    c.strokeStyle = c.fillStyle = colour
    c.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio])
    c.font = `${10 * devicePixelRatio}px system-ui, sans-serif`
    const taken: number[] = [] // where the names of each row end
    for (const mark of this.shown?.marks ?? lines.marks) {
      const x = u.valToPos(mark.at, 'x', true)
      if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) continue
      c.beginPath()
      c.moveTo(x, u.bbox.top)
      c.lineTo(x, u.bbox.top + u.bbox.height)
      c.stroke()
      const free = taken.findIndex((end) => end < x)
      const row = free < 0 ? taken.length : free
      taken[row] = x + 4 * devicePixelRatio + c.measureText(mark.name).width
      c.fillText(mark.name, x + 2 * devicePixelRatio, u.bbox.top + (10 + 10 * row) * devicePixelRatio)
    }
    c.restore()
  }

  /** Show or hide a line by its name. */
  reveal(name: string, on: boolean): void {
    if (on) this.hidden.delete(name)
    else this.hidden.add(name)
    const at = this.plot?.series.findIndex((s) => s.label === name) ?? -1
    if (at > 0) this.plot!.setSeries(at, { show: on })
  }

  /** A line that follows a playback. */
  playhead(x: number | null): void {
    if (!this.plot || !this.head) return
    this.head.hidden = x === null
    if (x !== null) this.head.style.transform = `translateX(${this.plot.valToPos(x, 'x')}px)`
  }

  private fit(): void {
    const width = this.element.clientWidth
    if (!this.plot) this.build()
    else if (width > 40 && width !== this.plot.width) this.plot.setSize({ width, height: this.height() })
  }

  figure(): SVGSVGElement {
    const lines = this.shown!
    const seen = lines.series.filter((s) => !this.hidden.has(s.name))
    return lineFigure({ ...lines, series: seen }, { ...theme(), size: 12 })
  }

  get ready(): boolean {
    return this.shown !== null
  }
}

/** Whether a plot of one shows the other when only its data are replaced. */
function alike(a: Lines, b: Lines): boolean {
  return a.title === b.title && a.series.length === b.series.length && a.x.log === b.x.log && a.y.label === b.y.label
}

function axis(scale: Scale, wanted: number, t: Theme): uPlot.Axis {
  return {
    label: scale.label,
    labelSize: 18,
    labelFont: '11px system-ui, sans-serif',
    font: '11px system-ui, sans-serif',
    stroke: t.muted,
    grid: { stroke: t.grid, width: 1 },
    ticks: { show: false },
    splits: (_u, _i, min, max) => ticks({ ...scale, min, max }, wanted),
    values: (_u, splits) => splits.map((v) => tickText(v, scale)),
    filter: (_u, splits) => splits,
  }
}

/** Scales with the ranges of the lines shown; a drag across zooms x alone. */
function scales(shown: () => Lines): uPlot.Scales {
  const { x, y } = shown()
  return {
    x: {
      time: false,
      distr: x.log ? 3 : 1,
      min: x.min,
      max: x.max,
      range: (_u, min, max) => [min ?? shown().x.min, max ?? shown().x.max],
    },
    y: { distr: y.log ? 3 : 1, min: y.min, max: y.max, range: () => [shown().y.min, shown().y.max] },
  }
}

function line(series: Series, show: boolean): uPlot.Series {
  return {
    label: series.name,
    stroke: series.colour,
    dash: series.dash,
    width: 1.5,
    points: { show: false },
    show,
    value: (_u, v) => sig(v, 3),
  }
}
