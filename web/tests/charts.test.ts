import { expect, test } from 'vitest'
import { cividis, css, signed, viridis } from '../src/charts/colourmaps'
import { Density, type Frame, WIDTH } from '../src/charts/density'
import { fraction, span, ticks, tickText, valueAt } from '../src/charts/scale'

const linear = { label: 'x', min: -2, max: 6 }
const log = { label: 'y', min: 1, max: 1000, log: true }

test('colour maps begin and end with their colours, and grow brighter', () => {
  expect(css(cividis(0))).toBe('rgb(0,34,78)')
  expect(css(viridis(1))).toBe('rgb(253,231,37)')
  expect(cividis(-1)).toEqual(cividis(0))
  expect(cividis(Number.NaN)).toEqual(cividis(0))
  expect(signed(0.5)).toEqual([217, 217, 217])
  const brightness = [0, 0.25, 0.5, 0.75, 1].map((t) => viridis(t).reduce((a, b) => a + b))
  expect(brightness).toEqual([...brightness].sort((a, b) => a - b))
})

test('a place on an axis is the fraction of its value', () => {
  for (const scale of [linear, log]) {
    for (const t of [0, 0.3, 1]) expect(fraction(scale, valueAt(scale, t))).toBeCloseTo(t, 12)
  }
  expect(fraction(log, 10)).toBeCloseTo(1 / 3, 12)
})

test('ticks are round numbers within the axis', () => {
  expect(ticks(linear, 4)).toEqual([-2, 0, 2, 4, 6])
  expect(ticks(log, 5)).toEqual([1, 10, 100, 1000])
  expect(ticks({ ...linear, max: -2 }, 4)).toEqual([-2])
  expect(tickText(-0.5, linear)).toBe('−0.5')
  expect(tickText(2e6, linear)).toBe('2e6')
})

test('the range of lines leaves room, and cuts off what has no top', () => {
  expect(span([[0, 10, null]], false)).toEqual([-0.6, 10.6])
  expect(span([[]], false)).toEqual([-1, 1])
  expect(span([[5, 5]], false, 0, 1e-6)).toEqual([5 - 1e-6, 5 + 1e-6])
  const [low, high] = span([[1, 2, 3, 1e12]], true)
  expect(low).toBeGreaterThan(0)
  expect(high).toBe(3e4)
})

const sum = (counts: Uint32Array) => counts.reduce((a, b) => a + b)

test('the nearest point of a cloud is found, and pixels are counted', () => {
  const places = [
    [10, 0.5],
    [100, 0.25],
  ] // cond(H), index
  const data = new Float32Array(places.flatMap(([condition, index], i) => [0, 0, 0, 0, 0, 0, index, condition, i]))
  const points = { data, count: data.length / WIDTH }
  const box = { left: 0, top: 0, width: 300, height: 200 }
  const frame: Frame = { x: log, y: { label: 'index', min: 0, max: 1 }, box }
  const density = new Density()
  const counts = density.counts(points, frame, [30, 20])
  expect(sum(counts.counted)).toBe(8) // four pixels each
  expect(sum(counts.beyond)).toBe(0)
  const within = density.counts(points, frame, [30, 20], false)
  expect([sum(within.counted), sum(within.beyond)]).toEqual([4, 4])
  expect(density.nearest(points, frame, [101, 99])).toBe(0)
  expect(density.nearest(points, frame, [203, 148])).toBe(1)
  expect(density.nearest(points, frame, [20, 20])).toBe(-1)
})
