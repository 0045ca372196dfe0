// The rows of a simulation: as lines of plots, as displacements of the drawn machine, and as a table.

import type { Lines } from '../charts/line-figure'
import { span } from '../charts/scale'
import { categories, DASHES } from '../charts/theme'
import { type Twist, twist } from '../machine3d/twist'
import { COORDINATES, type SimulationRun } from '../state/answers'

const COLUMNS = 25 // time, displacements of platform and base, leg lengths, leg forces: 1 + 6 + 6 + 6 + 6
const [PLATFORM, BASE] = [1, 7] // first column of each displacement
const ROUNDING = 1e-6 // mm, mrad or N: what is below is an error of rounding
const LEGS = [1, 2, 3, 4, 5, 6]

export interface Run extends SimulationRun {
  rows: Float32Array
}

interface Plot {
  title: string
  label: string
  names: string[]
  columns: number[]
  factor: number // from m, rad and N to the unit of the label
  colours: number[]
}

const PLOTS: Plot[] = [
  {
    title: 'Displacement from rest',
    label: 'displacement, mm',
    names: ['x', 'y', 'z', 'base x', 'base y', 'base z'],
    columns: [1, 2, 3, 7, 8, 9],
    factor: 1e3,
    colours: [0, 1, 2, 0, 1, 2],
  },
  {
    title: 'Rotation from rest (rotation vector)',
    label: 'rotation vector, mrad',
    names: ['about x', 'about y', 'about z', 'base about x', 'base about y', 'base about z'],
    columns: [4, 5, 6, 10, 11, 12],
    factor: 1e3,
    colours: [0, 1, 2, 0, 1, 2],
  },
  {
    title: 'Leg forces',
    label: 'force, N',
    names: LEGS.map((n) => `leg ${n}`),
    columns: [19, 20, 21, 22, 23, 24],
    factor: 1,
    colours: [0, 1, 2, 3, 4, 5],
  },
]

/** When the run ends, s. */
export function endOf(run: Run): number {
  return run.rows[(run.count - 1) * COLUMNS]
}

/** The lines of the three plots: displacements, rotations, leg forces. */
export function runLines({ rows, count }: Run): Lines[] {
  const column = (c: number, factor: number) =>
    Float64Array.from({ length: count }, (_, i) => rows[i * COLUMNS + c] * factor)
  const at = column(0, 1)
  const x = { label: 'time, s', min: 0, max: at[count - 1] }
  return PLOTS.map(({ title, label, names, columns, factor, colours }) => {
    const values = columns.map((c) => column(c, factor))
    const none = values.every((series) => series.every((v) => Math.abs(v) < ROUNDING))
    const [min, max] = none ? [-1, 1] : span(values, false, 0, ROUNDING) // rounding is drawn as a straight line
    const axis = none ? `${label}: none` : label
    const series = names.map((name, k) => {
      return { name, colour: categories()[colours[k]], dash: DASHES[k], values: values[k] }
    })
    return { title, x, y: { label: axis, min, max }, at, series, marks: [] }
  })
}

/** Displacements of platform and base at a time, s, as drawn. */
export function twistsAt({ rows, count, factor }: Run, seconds: number): [Twist, Twist] {
  let [low, high] = [0, count - 1]
  while (high - low > 1) {
    const middle = (low + high) >> 1
    if (rows[middle * COLUMNS] <= seconds) low = middle
    else high = middle
  }
  const [a, b] = [low * COLUMNS, high * COLUMNS]
  const share = rows[b] > rows[a] ? (seconds - rows[a]) / (rows[b] - rows[a]) : 0
  const between = (i: number) => rows[a + i] + share * (rows[b + i] - rows[a + i])
  const at = (first: number) => COORDINATES.map((_, i) => between(first + i))
  return [twist(at(PLATFORM), factor), twist(at(BASE), factor)]
}

/** Head and rows of the table. */
export function runTable({ rows, count }: Run): [string[], number[][]] {
  const three = (name: string, unit: string) => ['x', 'y', 'z'].map((c) => `${name}_${c}_${unit}`)
  const six = (body: string) => [...three(body, 'm'), ...three(`${body}_rotation_vector`, 'rad')]
  const legs = (name: string) => LEGS.map((n) => `leg_${n}_${name}`)
  const head = ['time_s', ...six('platform'), ...six('base'), ...legs('length_m'), ...legs('force_n')]
  const row = (i: number) => Array.from(rows.subarray(i * COLUMNS, (i + 1) * COLUMNS))
  return [head, Array.from({ length: count }, (_, i) => row(i))]
}
