// Any number of points: how many fall on each pixel, as colours, and which point is nearest to a place.

import type { Box2 } from './axes'
import type { ColourMap } from './colourmaps'
import { fraction, type Scale } from './scale'

export const WIDTH = 8 // numbers of one point: x y z roll pitch yaw index cond(H)
export const INDEX = 6
export const CONDITION = 7
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

/** Colours of the pixels by the number of points on them; a pixel without points stays clear. */
export function shaded(counts: Uint32Array, most: number, size: [number, number], colour: ColourMap): ImageData {
  const image = new ImageData(...size)
  const scale = 1 / Math.log(most)
  const palette = Array.from({ length: 257 }, (_, i) => colour(i / 256))
  for (let p = 0; p < counts.length; p++) {
    if (!counts[p]) continue
    const [r, g, b] = palette[Math.round(256 * Math.min(1, Math.log(counts[p]) * scale))]
    image.data.set([r, g, b, 255], 4 * p)
  }
  return image
}

export class Density {
  private first = new Int32Array(0) // of the points in each cell
  private next = new Int32Array(0) // point in the same cell, after each point
  private columns = 0

  /** Counts of points on `w` by `h` pixels. The lookup grid is filled on the way. */
  counts({ data, count }: Points, { x, y, box }: Frame, [w, h]: [number, number]): Uint32Array {
    const counts = new Uint32Array(w * h)
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
      for (let a = 0; a < dot; a++) for (let b = 0; b < dot; b++) counts[(py + a) * w + px + b]++
    }
    return counts
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
