// What the server sends. null stands for a number that does not exist at this pose.

export type Num = number | null
export const COORDINATES = ['x', 'y', 'z', 'roll', 'pitch', 'yaw'] as const
export type Coordinate = (typeof COORDINATES)[number]

export interface Field {
  key: string
  meaning: string
  unit: string
  shapes: number[][]
  optional: boolean
}

export interface Start {
  version: string
  presets: Record<string, string>
  start: { name: string; text: string } | null
  fields: Field[]
}

export interface ChiefNumber {
  key: string
  label: string
  unit: string
  logarithmic: boolean
  original: number
  value: number
  size: number
}

export interface Box {
  low: number[]
  high: number[]
}

export interface Described {
  name: string
  digest: string
  warnings: string[]
  values: Record<string, unknown>
  chief: ChiefNumber[]
  home: number[]
  box: Box
  leg: number
  toml: string
}

export interface Geometry {
  base: number[][]
  axes: number[][]
  platform: number[][]
  mass_center: number[]
  position: number[]
  matrix: number[][]
}

export interface Snapshot {
  pose: number[]
  geometry: Geometry
  omega: Num[]
  frequency: Num[]
  index: Num
  condition: Num
  shape: number[][]
  modes: { text: string; dominant: string; share: Num[] }[]
  strain: Num[][]
  damped: { omega: Num[]; frequency: Num[]; ratio: Num[] } | null
  sampling_time: Num
  legs: { length: Num[]; universal: Num[]; spherical: Num[]; force: Num[] | null; energy: Num[] | null; why: string }
  leg_distance: Num
  limits: { any: boolean; ok: boolean; exceeded: string[]; by_leg: string[][] }
  warnings: string[]
  near_repeated: [number, number][]
}

export interface FieldError {
  key: string
  message: string
  line: number
}
