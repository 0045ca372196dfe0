// Lines over x on the page (uPlot), redrawn in the theme's colours, and the same as a figure for files.

import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import { lineFigure, tickText, ticks, type Scale, type Series } from './chart'
import { theme } from './colours'
import { h } from '../widgets/dom'
import { sig } from '../widgets/format'

export interface Lines {
  title: string
  x: Scale
  y: Scale
  at: ArrayLike<number>
  series: Series[]
  marks: { at: number; name: string }[]
}

export class LinePlot {
  readonly element = h('figure', { class: 'lines', role: 'group' })
  private plot: uPlot | null = null
  private shown: Lines | null = null
  private hidden = new Set<string>()
  private head: HTMLElement | null = null

  legend = true

  constructor(
    private readonly height: () => number,
    private readonly clicked: ((x: number) => void) | null = null,
    private readonly sync = '',
  ) {
    new ResizeObserver(() => this.fit()).observe(this.element)
  }

  show(lines: Lines): void {
    const same =
      this.plot &&
      this.shown &&
      this.shown.title === lines.title &&
      this.shown.series.length === lines.series.length &&
      this.shown.x.log === lines.x.log &&
      this.shown.y.label === lines.y.label
    this.shown = lines
    if (same) {
      this.plot!.setData(this.data(lines), false)
      this.plot!.batch(() => {
        this.plot!.setScale('x', { min: lines.x.min, max: lines.x.max })
        this.plot!.setScale('y', { min: lines.y.min, max: lines.y.max })
      })
    } else this.build()
  }

  /** Draw anew, in another theme. */
  readonly build = (): void => {
    this.plot?.destroy()
    this.plot = null
    const lines = this.shown
    if (!lines || this.element.clientWidth < 40) return
    this.element.setAttribute('aria-label', `${lines.title}: ${lines.y.label} over ${lines.x.label}`)
    this.plot = new uPlot(this.options(lines), this.data(lines), this.element)
    this.head = h('div', { class: 'playhead', hidden: true })
    this.plot.over.append(this.head)
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
    const axis = (scale: Scale, wanted: number): uPlot.Axis => ({
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
    })
    return {
      width: this.element.clientWidth,
      height: this.height(),
      padding: [8, 24, 0, 0],
      cursor: { drag: { x: true, y: false }, points: { size: 6 }, ...(this.sync ? { sync: { key: this.sync } } : {}) },
      legend: { show: this.legend },
      scales: {
        x: {
          time: false,
          distr: lines.x.log ? 3 : 1,
          min: lines.x.min,
          max: lines.x.max,
          range: (_u, min, max) => [min ?? lines.x.min, max ?? lines.x.max],
        },
        y: { distr: lines.y.log ? 3 : 1, min: lines.y.min, max: lines.y.max, range: (_u, min, max) => [min, max] },
      },
      axes: [
        { ...axis(lines.x, Math.max(2, this.element.clientWidth / 90)), size: 26 },
        { ...axis(lines.y, Math.max(2, this.height() / 45)), size: 58 },
      ],
      series: [
        { label: lines.x.label, value: (_u, v) => sig(v, 4) },
        ...lines.series.map(
          (s): uPlot.Series => ({
            label: s.name,
            stroke: s.colour,
            dash: s.dash,
            width: 1.5,
            points: { show: false },
            show: !this.hidden.has(s.name),
            value: (_u, v) => sig(v, 3),
          }),
        ),
      ],
      hooks: {
        draw: [(u) => this.marks(u, lines, t.muted)],
        setSeries: [(u, i) => i !== null && this.remember(u.series[i])],
      },
    }
  }

  private remember(series: uPlot.Series): void {
    const name = String(series.label)
    if (series.show) this.hidden.delete(name)
    else this.hidden.add(name)
  }

  private marks(u: uPlot, lines: Lines, colour: string): void {
    const c = u.ctx
    c.save()
    c.strokeStyle = c.fillStyle = colour
    c.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio])
    c.font = `${10 * devicePixelRatio}px system-ui, sans-serif`
    let last = -Infinity
    for (const mark of this.shown?.marks ?? lines.marks) {
      const x = u.valToPos(mark.at, 'x', true)
      if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) continue
      c.beginPath()
      c.moveTo(x, u.bbox.top)
      c.lineTo(x, u.bbox.top + u.bbox.height)
      c.stroke()
      if (x - last > 14 * devicePixelRatio)
        c.fillText(mark.name, x + 2 * devicePixelRatio, u.bbox.top + 10 * devicePixelRatio)
      last = x
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
    return lineFigure(lines.title, { ...lines.x, values: lines.at }, lines.y, seen, lines.marks, {
      ...theme(),
      size: 12,
    })
  }

  get ready(): boolean {
    return this.shown !== null
  }
}

/** Least and greatest of several series, with a little room; logarithmic axes span at most some decades, others at least `least`. */
export function span(series: ArrayLike<number | null>[], log: boolean, decades = 7, least = 0): [number, number] {
  let [low, high] = [Infinity, -Infinity]
  for (const values of series) {
    for (let i = 0; i < values.length; i++) {
      const v = values[i]
      if (v === null || !Number.isFinite(v) || (log && v <= 0)) continue
      if (v < low) low = v
      if (v > high) high = v
    }
  }
  if (!(high >= low)) return log ? [0.1, 10] : [-1, 1]
  if (log) {
    const sorted = series.map((values) =>
      Array.from(values)
        .filter((v): v is number => v !== null && Number.isFinite(v) && v > 0)
        .sort((a, b) => a - b),
    )
    const usual = Math.max(...sorted.map((values) => values[values.length >> 1] ?? 0))
    const top = Math.min(high * 1.5, usual * 1e4) // an undamped peak has no top worth showing
    const seen = sorted
      .flat()
      .filter((v) => v > top / 10 ** decades)
      .sort((a, b) => a - b)
    return [(seen[Math.floor(seen.length / 50)] ?? low) / 2, Math.max(top, low * 4)]
  }
  const room = Math.max(0.06 * (high - low), least) || 0.1 * Math.abs(high) || 1
  return [low - room, high + room]
}
