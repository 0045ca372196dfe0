// Axes as numbers: places along them, ticks, ranges. Nothing is drawn here.

import { sig } from '../widgets/format'

export interface Scale {
  label: string
  min: number
  max: number
  log?: boolean
  every?: number // step of the ticks, where a round number is not it
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
  const { min, max, every } = scale
  if (!(max > min)) return [min]
  if (every && (max - min) / every <= 2 * wanted) return steps(min, max, every)
  if (scale.log && max / min >= 8) {
    const decades = Math.log10(max / min)
    const jump = Math.max(1, Math.ceil(decades / wanted))
    const within = decades <= 1.5 ? [1, 2, 5] : decades <= 2.5 ? [1, 3] : [1]
    const found: number[] = []
    for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); e += jump)
      for (const s of within) found.push(s * 10 ** e)
    return found.filter((v) => v >= min * 0.999999 && v <= max * 1.000001)
  }
  const rough = (max - min) / wanted
  const power = 10 ** Math.floor(Math.log10(rough))
  const step = power * ([1, 2, 5, 10].find((s) => s * power >= rough) ?? 10)
  return steps(min, max, step)
}

/** Multiples of a step within a range. */
function steps(min: number, max: number, step: number): number[] {
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

/** Words for a screen reader about a plot's range. */
export function rangeWords(x: Scale, y: Scale): string {
  const range = ({ label, min, max }: Scale) => `${label} from ${sig(min, 3)} to ${sig(max, 3)}`
  return `${range(y)} over ${range(x)}`
}

/**
 * Least and greatest value of several series, with a little room.
 * Logarithmic axes span at most `decades`, linear ones at least `least`.
 */
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
    const top = Math.min(high * 1.5, usual * 1e4) // an undamped peak is infinitely high
    const seen = sorted
      .flat()
      .filter((v) => v > top / 10 ** decades)
      .sort((a, b) => a - b)
    return [(seen[Math.floor(seen.length / 50)] ?? low) / 2, Math.max(top, low * 4)]
  }
  const room = Math.max(0.06 * (high - low), least) || 0.1 * Math.abs(high) || 1
  return [low - room, high + room]
}
