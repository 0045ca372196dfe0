import { expect, test } from 'vitest'
import { allEqual, blank, put, shaped } from '../src/panels/nested'
import { fromAddress, toAddress } from '../src/state/address'
import { initialOptions, OPTION_KEYS, OPTIONS } from '../src/state/options'
import { differences, listed } from '../src/state/question'
import { type Page, store } from '../src/state/store'

const PRESETS = { 'motion-base': 'name = "x"' }

/** Options whose other values must be looked up: choices. */
const OTHERS: Partial<Page> = {
  tab: 'time',
  joint: 'spin_free',
  unit: 'm',
  colour: 'strain',
  view: '1,-2,3,0,0,0.5',
  points: '10000',
  limits: 'all',
  scale: 'log',
  map: 'condition',
  across: 'yaw',
  up: 'roll',
  response: 'leg_force',
  panels: 'phase',
  output: '6',
  frequency_unit: 'rad',
  shake_axis: 'x',
  motion: 'csv',
  motion_axis: 'pitch',
  speed: '1000',
  design_view: 'toml',
}

function differentFrom(value: unknown): unknown {
  if (typeof value === 'boolean') return !value
  if (typeof value === 'number') return value === 1 ? 0.5 : 1
  return ['base about x', 'y']
}

async function restored(patch: Partial<Page>): Promise<Partial<Page>> {
  const { state, faults } = await fromAddress(`#${await toAddress({ ...store.page, ...patch })}`, PRESETS)
  expect(faults).toEqual([])
  return state
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
  expect(await restored(state)).toEqual({ ...initialOptions(), ...state })
})

test('a design of its own is packed into the address', async () => {
  const text = `name = "täst"\n${'# a comment\n'.repeat(500)}`
  const found = await restored({ preset: '', text })
  expect(found).toMatchObject({ preset: '', text })
  expect((await toAddress({ ...store.page, text })).length).toBeLessThan(300)
})

test('what an address leaves out is as at first', async () => {
  const { state } = await fromAddress('design=motion-base', PRESETS)
  expect(state).toEqual({ preset: 'motion-base', text: PRESETS['motion-base'], changes: {}, ...initialOptions() })
})

test('every option is in the address, and comes back as it was', async () => {
  for (const key of OPTION_KEYS) {
    const other = OTHERS[key] ?? differentFrom(OPTIONS[key].initial)
    expect(await restored({ preset: 'motion-base', [key]: other }), key).toMatchObject({ [key]: other })
  }
})

test('what an address says wrongly is told, and the rest is used', async () => {
  const wrong =
    'design=none&pose=1,2,x,4,5,6&mode=7&joint=ball&colour=red&unit=inch&changes={"a":1&box=1,2&seed=&what=1&labels=1'
  const { state, faults } = await fromAddress(wrong, PRESETS)
  expect(state).toEqual({ changes: {}, ...initialOptions() })
  const told = [
    '“none”',
    'six numbers',
    'mode',
    'joint',
    'colour',
    'unit',
    'changes',
    'twelve',
    'seed',
    'what',
    'labels',
  ]
  for (const word of told) expect(faults.join(), word).toContain(word)
  expect(faults.length).toBe(told.length)
  for (const name of ['constructor', 'toString', '__proto__'])
    expect((await fromAddress(`design=${name}`, PRESETS)).faults[0]).toContain(`no design “${name}”`)
  for (const toml of ['%%%', 'abc'])
    expect((await fromAddress(`toml=${toml}&tab=time`, PRESETS)).faults).toEqual([
      'the design in it is damaged, as when a link is cut short',
    ])
  expect((await fromAddress('mode=2.5', PRESETS)).faults.length).toBe(1)
})

test('questions differ in words', () => {
  const asked = { ...store.question(), box: { low: [1] }, points: 3 }
  expect(differences(asked, structuredClone(asked))).toEqual([])
  expect(differences(asked, { ...asked, changes: { a: 1 }, design: 'x', points: 4, box: { low: [2] } })).toEqual([
    'design',
    'pose box',
    'settings',
  ])
  expect([listed(['a']), listed(['a', 'b', 'c'])]).toEqual(['a', 'a, b and c'])
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
