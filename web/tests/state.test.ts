import { expect, test } from 'vitest'
import { allEqual, blank, put, shaped } from '../src/panels/nested'
import { fromAddress, toAddress } from '../src/state/address'
import { type Page, store } from '../src/state/store'

const PRESETS = { 'motion-base': 'name = "x"' }

async function restored(patch: Partial<Page>): Promise<Partial<Page>> {
  return fromAddress(`#${await toAddress({ ...store.page, ...patch })}`, PRESETS)
}

test('an address restores the state of a page', async () => {
  const state: Partial<Page> = {
    preset: 'motion-base',
    text: PRESETS['motion-base'],
    changes: { 'platform.mass': 40, 'legs.stiffness[2]': 5e7 },
    pose: [0.001, -2, 1 / 3, 0, 90, 1e-7],
    joint: 'spin_free',
    mode: 5,
    colour: 'strain',
    unit: 'm',
    tab: 'legs',
  }
  expect(await restored(state)).toEqual(state)
})

test('a design of its own is packed into the address', async () => {
  const text = `name = "täst"\n${'# a comment\n'.repeat(500)}`
  const found = await restored({ preset: '', text })
  expect(found).toMatchObject({ preset: '', text })
  expect((await toAddress({ ...store.page, text })).length).toBeLessThan(300)
})

test('what an address says wrongly is left out', async () => {
  const wrong = 'design=none&pose=1,2,x,4,5,6&mode=7&joint=ball&colour=red&unit=inch&changes={"a":1&box=1,2'
  expect(await fromAddress(wrong, PRESETS)).toEqual({})
  expect(await fromAddress('mode=2.5', PRESETS)).toEqual({ changes: {} })
  expect(await fromAddress('toml=%%%&tab=time', PRESETS)).toMatchObject({ preset: '', text: '', tab: 'time' })
})

test('listeners hear of the keys that they named', () => {
  const heard: string[] = []
  store.on(['pose', 'joint'], () => heard.push('pose'))
  store.on(['tab'], () => heard.push('tab'))
  store.set({ pose: [1, 2, 3, 4, 5, 6], joint: 'universal' })
  store.set({ unit: 'm' })
  expect(heard).toEqual(['pose'])
  expect(store.question().pose).toEqual([1, 2, 3, 4, 5, 6])
})

test('a value that is the same for all legs is shown once', () => {
  const shapes = [[], [6]]
  expect(
    allEqual([
      [1, 2],
      [1, 2],
    ]),
  ).toBe(true)
  expect(shaped([3, 3, 3, 3, 3, 3], shapes, false)).toBe(3)
  expect(shaped(3, shapes, true)).toEqual([3, 3, 3, 3, 3, 3])
  expect(shaped([1, 2, 3, 4, 5, 6], shapes, false)).toEqual([1, 2, 3, 4, 5, 6])
  expect(shaped(undefined, [[3, 3], [3]], false)).toEqual([Number.NaN, Number.NaN, Number.NaN])
})

test('a number is put at its place', () => {
  expect(put(blank([2, 2]), [1, 0], 5)).toEqual([
    [Number.NaN, Number.NaN],
    [5, Number.NaN],
  ])
  expect(put(1, [], 2)).toBe(2)
})
