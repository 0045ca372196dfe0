// A plot of lines as a figure for files: axes, lines, marks and a legend.

import { svg } from '../widgets/dom'
import { axes, type Box2, type Look } from './axes'
import { fraction, type Scale } from './scale'

export interface Series {
  name: string
  colour: string
  dash: number[]
  values: ArrayLike<number | null>
}

export interface Mark {
  at: number
  name: string
}

export interface Lines {
  title: string
  x: Scale
  y: Scale
  at: ArrayLike<number> // x of the values
  series: Series[]
  marks: Mark[]
}

const FONT = 'system-ui, sans-serif'
const [WIDTH, HEIGHT] = [760, 460]
const BOX: Box2 = { left: 78, top: 34, width: WIDTH - 200, height: HEIGHT - 90 }

export function lineFigure(lines: Lines, look: Look): SVGSVGElement {
  const figure = svg('svg', {
    xmlns: 'http://www.w3.org/2000/svg',
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    width: WIDTH,
    height: HEIGHT,
  })
  const { left, top, width, height } = BOX
  const heading = { x: left, y: 20, fill: look.text, 'font-family': FONT, 'font-size': 14, 'font-weight': 600 }
  const clip = svg('clipPath', { id: 'plot' }, svg('rect', { x: left, y: top, width, height }))
  figure.append(
    svg('rect', { width: WIDTH, height: HEIGHT, fill: look.paper }),
    svg('text', heading, lines.title),
    svg('defs', {}, clip),
    axes(BOX, lines.x, lines.y, look),
    ...lines.marks.flatMap((mark) => markAt(mark, lines.x, look)),
    ...lines.series.flatMap((series, i) => [curve(lines, series), ...legend(series, i, look)]),
  )
  return figure
}

function markAt(mark: Mark, x: Scale, look: Look): SVGElement[] {
  const t = fraction(x, mark.at)
  if (t < 0 || t > 1) return []
  const at = BOX.left + BOX.width * t
  const line = { x1: at, x2: at, y1: BOX.top, y2: BOX.top + BOX.height, stroke: look.muted, 'stroke-dasharray': '2 3' }
  const text = { x: at + 3, y: BOX.top + 12, 'font-size': 10, 'font-family': FONT, fill: look.muted }
  return [svg('line', line), svg('text', text, mark.name)]
}

function curve(lines: Lines, series: Series): SVGElement {
  return svg('path', {
    d: path(lines, series.values),
    fill: 'none',
    stroke: series.colour,
    'stroke-width': 1.5,
    'stroke-dasharray': series.dash.join(' '),
    'clip-path': 'url(#plot)',
  })
}

function legend(series: Series, i: number, look: Look): SVGElement[] {
  const [x1, y] = [BOX.left + BOX.width + 14, BOX.top + 10 + 18 * i]
  const dash = series.dash.join(' ')
  const line = { x1, x2: x1 + 22, y1: y, y2: y, stroke: series.colour, 'stroke-width': 2, 'stroke-dasharray': dash }
  const text = { x: x1 + 28, y: y + 4, 'font-size': 12, 'font-family': FONT, fill: look.text }
  return [svg('line', line), svg('text', text, series.name)]
}

/** The path through the values; it breaks where they do not exist. */
function path({ x, y, at }: Lines, values: ArrayLike<number | null>): string {
  let d = ''
  let pen = false
  for (let i = 0; i < values.length; i++) {
    const value = values[i]
    if (value === null || !Number.isFinite(value) || (y.log && value <= 0)) {
      pen = false
      continue
    }
    const px = BOX.left + BOX.width * fraction(x, at[i])
    const py = BOX.top + BOX.height * (1 - fraction(y, value))
    d += `${pen ? 'L' : 'M'}${px.toFixed(1)} ${py.toFixed(1)}`
    pen = true
  }
  return d
}

/** Several figures as one, in columns. */
export function joinedFigure(figures: SVGSVGElement[], columns: number): SVGSVGElement {
  const [across, down] = [columns * WIDTH, Math.ceil(figures.length / columns) * HEIGHT]
  const whole = figures[0].cloneNode(false) as SVGSVGElement
  whole.setAttribute('viewBox', `0 0 ${across} ${down}`)
  whole.setAttribute('width', String(across))
  whole.setAttribute('height', String(down))
  figures.forEach((figure, i) => {
    figure.setAttribute('x', String((i % columns) * WIDTH))
    figure.setAttribute('y', String(Math.floor(i / columns) * HEIGHT))
    whole.append(figure)
  })
  return whole
}
