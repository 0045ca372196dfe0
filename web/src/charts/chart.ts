// Axes drawn as SVG: on the page over a canvas of points, and in the files that a figure is saved to.

import { svg } from '../widgets/dom'
import { sig } from '../widgets/format'
import type { Theme } from './colours'

export interface Scale {
  label: string
  min: number
  max: number
  log?: boolean
}

export interface Box2 {
  left: number
  top: number
  width: number
  height: number
}

/** Where a value lies along an axis, 0 to 1. */
export function fraction(scale: Scale, value: number): number {
  if (scale.log) return Math.log(value / scale.min) / Math.log(scale.max / scale.min)
  return (value - scale.min) / (scale.max - scale.min)
}

export function valueAt(scale: Scale, t: number): number {
  return scale.log ? scale.min * (scale.max / scale.min) ** t : scale.min + t * (scale.max - scale.min)
}

/** Round values within a range, about `wanted` of them. */
export function ticks(scale: Scale, wanted: number): number[] {
  const { min, max } = scale
  if (!(max > min)) return [min]
  if (scale.log && max / min >= 8) {
    const decades = Math.log10(max / min)
    const every = Math.max(1, Math.ceil(decades / wanted))
    const steps = decades <= 1.5 ? [1, 2, 5] : decades <= 2.5 ? [1, 3] : [1]
    const found: number[] = []
    for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); e += every)
      for (const s of steps) found.push(s * 10 ** e)
    return found.filter((v) => v >= min * 0.999999 && v <= max * 1.000001)
  }
  const rough = (max - min) / wanted
  const power = 10 ** Math.floor(Math.log10(rough))
  const step = power * ([1, 2, 5, 10].find((s) => s * power >= rough) ?? 10)
  const found: number[] = []
  for (let i = Math.ceil(min / step - 1e-9); i * step <= max + 1e-9 * step; i++) found.push(i * step)
  return found
}

export function tickText(value: number, scale: Scale): string {
  if (value === 0) return '0'
  const size = Math.abs(value)
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replace('.0e', 'e').replace('+', '').replace(/-/g, '−')
  return String(Number(value.toPrecision(scale.log ? 3 : 6))).replace('-', '−')
}

export interface Look extends Theme {
  size: number // of text, px
}

/** Frame, grid lines, ticks and labels of a plot. */
export function axes(box: Box2, x: Scale, y: Scale, look: Look): SVGGElement {
  const group = svg('g', { 'font-family': 'system-ui, sans-serif', 'font-size': look.size, fill: look.text })
  const { left, top, width, height } = box
  const text = (at: [number, number], words: string, more: Record<string, unknown> = {}) =>
    group.append(svg('text', { x: at[0], y: at[1], 'text-anchor': 'middle', ...more }, words))
  const line = (x1: number, y1: number, x2: number, y2: number) =>
    group.append(svg('line', { x1, y1, x2, y2, stroke: look.muted, 'stroke-opacity': 0.28 }))
  for (const value of ticks(x, Math.max(3, width / 70))) {
    const at = left + width * fraction(x, value)
    line(at, top, at, top + height)
    text([at, top + height + look.size + 4], tickText(value, x), { fill: look.muted })
  }
  for (const value of ticks(y, Math.max(3, height / 50))) {
    const at = top + height * (1 - fraction(y, value))
    line(left, at, left + width, at)
    text([left - 5, at + 0.35 * look.size], tickText(value, y), { 'text-anchor': 'end', fill: look.muted })
  }
  group.append(svg('rect', { x: left, y: top, width, height, fill: 'none', stroke: look.muted }))
  text([left + width / 2, top + height + 2.5 * look.size + 6], x.label)
  const middle = top + height / 2
  text([11, middle], y.label, { transform: `rotate(-90 11 ${middle})` })
  return group
}

/** A colour bar with its ticks, beside a plot. */
export function bar(box: Box2, scale: Scale, colour: (t: number) => string, look: Look): SVGGElement {
  const group = svg('g', { 'font-family': 'system-ui, sans-serif', 'font-size': look.size, fill: look.text })
  const steps = 64
  for (let i = 0; i < steps; i++) {
    const height = box.height / steps
    group.append(
      svg('rect', {
        x: box.left,
        y: box.top + box.height - (i + 1) * height,
        width: box.width,
        height: height + 0.5,
        fill: colour((i + 0.5) / steps),
      }),
    )
  }
  for (const value of ticks(scale, 5)) {
    const y = box.top + box.height * (1 - fraction(scale, value))
    group.append(
      svg('text', { x: box.left + box.width + 5, y: y + 0.35 * look.size, fill: look.muted }, tickText(value, scale)),
    )
  }
  const x = box.left + box.width + 52
  const middle = box.top + box.height / 2
  group.append(
    svg('text', { x, y: middle, 'text-anchor': 'middle', transform: `rotate(-90 ${x} ${middle})` }, scale.label),
  )
  return group
}

export interface Series {
  name: string
  colour: string
  dash: number[]
  values: ArrayLike<number | null>
}

/** A whole figure of lines over x for a file: axes, lines, marks and a legend. */
export function lineFigure(
  title: string,
  x: Scale & { values: ArrayLike<number> },
  y: Scale,
  series: Series[],
  marks: { at: number; name: string }[],
  look: Look,
): SVGSVGElement {
  const [width, height] = [760, 460]
  const box = { left: 78, top: 34, width: width - 200, height: height - 90 }
  const figure = svg('svg', { xmlns: 'http://www.w3.org/2000/svg', viewBox: `0 0 ${width} ${height}`, width, height })
  figure.append(svg('rect', { width, height, fill: look.paper }))
  figure.append(
    svg(
      'text',
      {
        x: box.left,
        y: 20,
        fill: look.text,
        'font-family': 'system-ui, sans-serif',
        'font-size': 14,
        'font-weight': 600,
      },
      title,
    ),
  )
  const clip = svg(
    'clipPath',
    { id: 'plot' },
    svg('rect', { x: box.left, y: box.top, width: box.width, height: box.height }),
  )
  figure.append(svg('defs', {}, clip), axes(box, x, y, look))
  for (const mark of marks) {
    const t = fraction(x, mark.at)
    if (t < 0 || t > 1) continue
    const at = box.left + box.width * t
    figure.append(
      svg('line', {
        x1: at,
        x2: at,
        y1: box.top,
        y2: box.top + box.height,
        stroke: look.muted,
        'stroke-dasharray': '2 3',
      }),
    )
    figure.append(
      svg(
        'text',
        { x: at + 3, y: box.top + 12, 'font-size': 10, 'font-family': 'system-ui, sans-serif', fill: look.muted },
        mark.name,
      ),
    )
  }
  series.forEach((line, i) => {
    figure.append(
      svg('path', {
        d: path(box, x, y, line.values),
        fill: 'none',
        stroke: line.colour,
        'stroke-width': 1.5,
        'stroke-dasharray': line.dash.join(' '),
        'clip-path': 'url(#plot)',
      }),
    )
    const top = box.top + 10 + 18 * i
    const left = box.left + box.width + 14
    figure.append(
      svg('line', {
        x1: left,
        x2: left + 22,
        y1: top,
        y2: top,
        stroke: line.colour,
        'stroke-width': 2,
        'stroke-dasharray': line.dash.join(' '),
      }),
    )
    figure.append(
      svg(
        'text',
        { x: left + 28, y: top + 4, 'font-size': 12, 'font-family': 'system-ui, sans-serif', fill: look.text },
        line.name,
      ),
    )
  })
  return figure
}

function path(box: Box2, x: Scale & { values: ArrayLike<number> }, y: Scale, values: ArrayLike<number | null>): string {
  let d = ''
  let pen = false
  for (let i = 0; i < values.length; i++) {
    const value = values[i]
    if (value === null || !Number.isFinite(value) || (y.log && value <= 0)) {
      pen = false
      continue
    }
    const px = box.left + box.width * fraction(x, x.values[i])
    const py = box.top + box.height * (1 - fraction(y, value))
    d += `${pen ? 'L' : 'M'}${px.toFixed(1)} ${py.toFixed(1)}`
    pen = true
  }
  return d
}

/** Words for a screen reader about a plot's range. */
export function rangeWords(x: Scale, y: Scale): string {
  return `${y.label} from ${sig(y.min, 3)} to ${sig(y.max, 3)} over ${x.label} from ${sig(x.min, 3)} to ${sig(x.max, 3)}`
}
