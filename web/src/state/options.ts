// Every control of the page beside design, pose and box, once: its value at first, and its value in a link.
// A control shows and changes one of these (widgets/bound.ts); what is not here is in no link.

import { COORDINATES, JOINT_MODELS } from './answers'

/** How an option is read from a link, and written into one. `undefined`: the text is no value of this option. */
export interface Rule<T> {
  initial: T
  read(text: string): T | undefined
  write(value: T): string
  words: string // what it takes
}

function choice<const T extends string>(values: readonly T[], initial: NoInfer<T>): Rule<T> {
  const read = (text: string) => values.find((value) => value === text)
  return { initial, read, write: String, words: `one of ${values.join(', ')}` }
}

function number(initial: number, least = 0, most = 1e9): Rule<number> {
  const read = (text: string) => {
    const value = text.trim() === '' ? Number.NaN : Number(text)
    return value >= least && value <= most ? value : undefined
  }
  return { initial, read, write: String, words: `a number from ${least} to ${most}` }
}

function yes(initial: boolean): Rule<boolean> {
  const read = (text: string) => ({ yes: true, no: false })[text]
  return { initial, read, write: (value) => (value ? 'yes' : 'no'), words: 'yes or no' }
}

/** Names without commas, such as lines that are hidden. */
function names(): Rule<string[]> {
  return { initial: [], read: (text) => text.split(',').filter(Boolean), write: String, words: 'names' }
}

const VIEWS = ['iso', 'front', 'side', 'top'] as const

/** A standard view, or where the camera stands and looks, six numbers. */
const view: Rule<string> = {
  initial: 'iso',
  read: (text) => ((VIEWS as readonly string[]).includes(text) || sixNumbers(text) ? text : undefined),
  write: String,
  words: `one of ${VIEWS.join(', ')}, or six numbers`,
}

const mode: Rule<number> = {
  initial: -1,
  read: (text) => ([1, 2, 3, 4, 5, 6].includes(Number(text)) ? Number(text) - 1 : undefined),
  write: (value) => String(value + 1),
  words: 'a number from 1 to 6',
}

export const TABS = ['modes', 'legs', 'workspace', 'response', 'time', 'design'] as const
export const COLOURS = ['plain', 'force', 'energy', 'strain'] as const

export const OPTIONS = {
  tab: choice(TABS, 'modes'),
  joint: choice(JOINT_MODELS, 'universal'),
  unit: choice(['mm', 'm'], 'mm'),
  // the 3-D view
  colour: choice(COLOURS, 'force'),
  view,
  labels: yes(true),
  wide: yes(false),
  // modes
  mode,
  drawn: number(0.35, 0, 1), // amplitude, share of the largest
  // workspace
  points: choice(['10000', '100000', '300000', '1000000'], '100000'),
  seed: number(1, 0, 2 ** 31),
  limits: choice(['within', 'all'], 'within'), // which poses count
  scale: choice(['linear', 'log'], 'linear'),
  map: choice(['index', 'condition'], 'index'),
  across: choice(COORDINATES, 'x'),
  up: choice(COORDINATES, 'y'),
  // response
  response: choice(['absolute', 'relative', 'compliance', 'command', 'leg_force'], 'absolute'),
  panels: choice(['all', 'one', 'phase'], 'all'),
  output: choice(['1', '2', '3', '4', '5', '6'], '3'),
  frequency_unit: choice(['Hz', 'rad'], 'Hz'),
  loss: number(0, 0, 2),
  hidden: names(), // lines
  shake_axis: choice(COORDINATES, 'z'),
  shake: number(0, 0, 1e9), // Hz; 0: near the first mode
  // time
  motion: choice(['harmonic', 'sweep', 'shock', 'step', 'csv'], 'harmonic'),
  motion_axis: choice(COORDINATES, 'z'),
  amplitude: number(1, -1e6, 1e6), // mm or degrees
  frequency: number(5, 1e-6, 1e6), // Hz
  end: number(50, 1e-6, 1e6), // Hz
  peak: number(10, -1e6, 1e6), // m/s² or rad/s²
  pulse: number(11, 1e-3, 1e6), // ms
  duration: number(1, 1e-6, 1e4), // s
  hidden_time: names(),
  speed: choice(['fit', '1', '10', '100', '1000'], 'fit'), // times slower than real time
  // design
  design_view: choice(['form', 'toml'], 'form'),
  each: names(), // fields that show each leg
}

export type OptionKey = keyof typeof OPTIONS
export type Options = { -readonly [K in OptionKey]: (typeof OPTIONS)[K]['initial'] }
/** The keys of options whose values are of a type. */
export type KeyOf<T> = { [K in OptionKey]: Options[K] extends T ? K : never }[OptionKey]

export const OPTION_KEYS = Object.keys(OPTIONS) as OptionKey[]

/** The rule of an option, whatever it is about. */
export const ruleOf = (key: OptionKey): Rule<unknown> => OPTIONS[key] as Rule<unknown>

/** All options as they are at first. */
export function initialOptions(): Options {
  return Object.fromEntries(OPTION_KEYS.map((key) => [key, OPTIONS[key].initial])) as unknown as Options
}

export function sixNumbers(text: string): number[] | null {
  const values = text.split(',').map((part) => (part.trim() === '' ? Number.NaN : Number(part)))
  return values.length === 6 && values.every(Number.isFinite) ? values : null
}
