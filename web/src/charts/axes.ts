// Axes and colour bars drawn as SVG: on the page over a canvas, and in the figures that are saved.

import { svg } from '../widgets/dom'
import type { Theme } from './look'
import { fraction, type Scale, ticks, tickText } from './scale'

export interface Box2 {
  left: number
  top: number
  width: number
  height: number
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
