// Any number of points: how many fall on each pixel, as colours, and which point is nearest to a place.

import type { Box2 } from './axes'
import type { ColourMap, Rgb } from './colourmaps'
import { fraction, type Scale } from './scale'

export const WIDTH = 9 // numbers of one point: x y z roll pitch yaw index cond(H) within
export const INDEX = 6
export const CONDITION = 7
export const WITHIN = 8 // 1 where the limits hold
const CELL = 6 // px of the grid in which the nearest point is looked up
const NEAR = 14 // px within which a point is found

export interface Points {
  data: Float32Array
  count: number
}

/** Index over cond(H) in a box: cond(H) on a logarithmic axis. */
export interface Frame {
  x: Scale
  y: Scale
  box: Box2
}

/** How many points fall on each pixel: those that count, and those beyond the limits where these do not count. */
export interface Counts {
  counted: Uint32Array
  beyond: Uint32Array
}

/** Colours of the pixels by the number of points on them, over grey ones for `beyond`; others stay clear. */
export function shaded(found: Counts, most: number, size: [number, number], colour: ColourMap, grey: Rgb): ImageData {
  const image = new ImageData(...size)
  const counts = found.counted
  const scale = 1 / Math.log(most)
  const palette = Array.from({ length: 257 }, (_, i) => colour(i / 256))
  for (let p = 0; p < counts.length; p++) {
    if (!counts[p]) {
      if (found.beyond[p]) image.data.set([...grey, 255], 4 * p)
      continue
    }
    const [r, g, b] = palette[Math.round(256 * Math.min(1, Math.log(counts[p]) * scale))]
    image.data.set([r, g, b, 255], 4 * p)
  }
  return image
}

export class Density {
  private first = new Int32Array(0) // of the points in each cell
  private next = new Int32Array(0) // point in the same cell, after each point
  private columns = 0

  /** Counts of points on `w` by `h` pixels; `all` count, or those within the limits. The lookup grid is filled too. */
  counts({ data, count }: Points, { x, y, box }: Frame, [w, h]: [number, number], all = true): Counts {
    const found = { counted: new Uint32Array(w * h), beyond: new Uint32Array(w * h) }
    this.columns = Math.ceil(box.width / CELL) + 1
    this.first = new Int32Array(this.columns * (Math.ceil(box.height / CELL) + 1)).fill(-1)
    if (this.next.length < count) this.next = new Int32Array(data.length / WIDTH)
    const dot = count > 400_000 ? 1 : 2
    const [x0, kx] = [Math.log(x.min), 1 / Math.log(x.max / x.min)]
    const log = y.log
    const y0 = log ? Math.log(y.min) : y.min
    const ky = 1 / ((log ? Math.log(y.max) : y.max) - y0)
    for (let i = 0; i < count; i++) {
      const tx = (Math.log(data[i * WIDTH + CONDITION]) - x0) * kx
      const index = data[i * WIDTH + INDEX]
      const ty = 1 - ((log ? Math.log(index) : index) - y0) * ky
      if (!(tx >= 0 && tx <= 1 && ty >= 0 && ty <= 1)) continue
      const cell = Math.floor((tx * box.width) / CELL) + this.columns * Math.floor((ty * box.height) / CELL)
      this.next[i] = this.first[cell]
      this.first[cell] = i
      const px = Math.min(w - dot, Math.floor(tx * w))
      const py = Math.min(h - dot, Math.floor(ty * h))
      const counts = all || data[i * WIDTH + WITHIN] ? found.counted : found.beyond
      for (let a = 0; a < dot; a++) for (let b = 0; b < dot; b++) counts[(py + a) * w + px + b]++
    }
    return found
  }

  /** The point nearest to a place in the box, px; -1 if none is near. */
  nearest({ data }: Points, { x, y, box }: Frame, [px, py]: [number, number]): number {
    const [cx, cy] = [Math.floor(px / CELL), Math.floor(py / CELL)]
    let [best, found] = [NEAR ** 2, -1]
    for (let gy = cy - 2; gy <= cy + 2; gy++) {
      for (let gx = cx - 2; gx <= cx + 2; gx++) {
        if (gx < 0 || gy < 0 || gx >= this.columns) continue
        for (let i = this.first[gy * this.columns + gx] ?? -1; i >= 0; i = this.next[i]) {
          const dx = fraction(x, data[i * WIDTH + CONDITION]) * box.width - px
          const dy = (1 - fraction(y, data[i * WIDTH + INDEX])) * box.height - py
          const distance = dx * dx + dy * dy
          if (distance < best) [best, found] = [distance, i]
        }
      }
    }
    return found
  }
}
