import { expect, test } from 'vitest'
import { count, duration, field, parsed, percent, sig } from '../src/widgets/format'

test('numbers have significant digits, and an exponent when very large or small', () => {
  expect(sig(123.456)).toBe('123.46')
  expect(sig(-0.5, 3)).toBe('−0.500')
  expect(sig(123456, 3)).toBe('123000')
  expect(sig(1.5e7, 3)).toBe('1.50e7')
  expect(sig(-2.5e-6, 2)).toBe('−2.5e−6')
  expect(sig(0)).toBe('0')
})

test('what does not exist is a dash, and infinity a sign', () => {
  expect([null, undefined, Number.NaN].map((v) => sig(v))).toEqual(['–', '–', '–'])
  expect(sig(Number.NEGATIVE_INFINITY)).toBe('−∞')
  expect(percent(null)).toBe('–')
})

test('typed numbers may have a decimal comma, spaces and a typographic minus', () => {
  expect(parsed(' −1,5 ')).toBe(-1.5)
  expect(parsed('1 000.5')).toBe(1000.5)
  expect(parsed('8e7')).toBe(8e7)
  for (const text of ['', '1,2,3', 'x']) expect(parsed(text)).toBeNaN()
})

test('a field shows all digits of a number and none of its rounding', () => {
  expect(field(0.1 + 0.2)).toBe('0.3')
  expect(field(8e7)).toBe('8e7')
  for (const value of [1 / 3, 123456.789, -4e-7]) expect(parsed(field(value))).toBeCloseTo(value, 11)
})

test('shares, durations and counts', () => {
  expect(percent(0.256)).toBe('26 %')
  expect([duration(0.25), duration(3.14)]).toEqual(['250 ms', '3.1 s'])
  expect(count(1_234_567)).toBe('1\u202f234\u202f567')
})
