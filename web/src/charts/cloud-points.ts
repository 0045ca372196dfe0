// The poses of a cloud with their numbers: which of them count, their order by index, and the ranges of their axes.

import { CONDITION, INDEX, WIDTH, WITHIN } from './density'
import type { Scale } from './scale'

export interface Point {
  six: number[] // x, y, z (m), roll, pitch, yaw (degrees)
  index: number
  condition: number
  within: boolean
}

export class CloudPoints {
  data = new Float32Array(0)
  count = 0

  /** Begin anew, for `total` points. */
  begin(total: number): void {
    this.data = new Float32Array(total * WIDTH)
    this.count = 0
  }

  /** Take more points; false if they are more than was said. */
  add(part: Float32Array): boolean {
    if (this.count * WIDTH + part.length > this.data.length) return false
    this.data.set(part, this.count * WIDTH)
    this.count += part.length / WIDTH
    return true
  }

  at(i: number): Point {
    const numbers = this.data.subarray(i * WIDTH, (i + 1) * WIDTH)
    const six = Array.from(numbers.subarray(0, 6))
    return { six, index: numbers[INDEX], condition: numbers[CONDITION], within: numbers[WITHIN] > 0 }
  }

  *rows(): Generator<number[]> {
    for (let i = 0; i < this.count; i++) yield Array.from(this.data.subarray(i * WIDTH, (i + 1) * WIDTH))
  }

  /** How many are within the limits. */
  get within(): number {
    let sum = 0
    for (let i = 0; i < this.count; i++) sum += this.data[i * WIDTH + WITHIN]
    return sum
  }

  /** Places of the points that count, `all` or those within the limits, sorted by index; those without one left out. */
  order(all: boolean): Uint32Array {
    const { data, count } = this
    const index = (i: number) => data[i * WIDTH + INDEX]
    const counts = (i: number) => all || data[i * WIDTH + WITHIN] > 0
    const places = new Uint32Array(count).map((_, i) => i).filter((i) => Number.isFinite(index(i)) && counts(i))
    return places.sort((a, b) => index(a) - index(b))
  }

  /** The axes of cond(H) and index with ranges that hold all points. */
  ranged(x: Scale, y: Scale): [Scale, Scale] {
    const { data, count } = this
    let [low, high, top, least] = [Infinity, 0, 0, Infinity]
    for (let i = 0; i < count; i++) {
      const condition = data[i * WIDTH + CONDITION]
      const index = data[i * WIDTH + INDEX]
      if (condition < low) low = condition
      if (condition > high && condition < 1e9) high = condition
      if (index > top) top = index
      if (index < least && (index > 1e-9 || !y.log)) least = index
    }
    if (count === 0 || low === Infinity) return [x, y]
    const across = { ...x, min: low / 1.05, max: Math.max(high * 1.05, low * 1.2) }
    if (y.log) return [across, { ...y, min: least / 1.1, max: top * 1.1 }]
    const room = 0.05 * (top - least)
    return [across, { ...y, min: least > 0.4 * top ? least - room : 0, max: top + room || 1 }]
  }
}
