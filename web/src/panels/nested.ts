// Values of a design's fields: a number, a list, a matrix, or a list of matrices.

export type Nested = number | Nested[]

export function allEqual(values: Nested[]): boolean {
  return values.every((value) => JSON.stringify(value) === JSON.stringify(values[0]))
}

/** A value of a shape in which all numbers are missing (NaN). */
export function blank(shape: number[]): Nested {
  return shape.length === 0 ? Number.NaN : Array.from({ length: shape[0] }, () => blank(shape.slice(1)))
}

/** The value with one number put at a place; lists are changed in place. */
export function put(value: Nested, path: number[], item: number): Nested {
  if (!path.length || !Array.isArray(value)) return item
  value[path[0]] = put(value[path[0]], path.slice(1), item)
  return value
}

/**
 * A value in the shape that a form has: one for all legs if they are alike, unless `each` leg is wanted.
 * `shapes` are those that the field takes.
 */
export function shaped(value: Nested | undefined, shapes: number[][], each: boolean): Nested {
  if (value === undefined) return blank([...shapes].sort((a, b) => a.length - b.length)[0])
  if (shapes.length < 2) return value
  const full = Array.isArray(value) && value.length === 6
  if (full && !each && allEqual(value)) return value[0]
  if (!full && each) return Array.from({ length: 6 }, () => value)
  return value
}

/** All numbers of a value in their order. */
export function flat(value: Nested): number[] {
  return [value].flat(3) as number[]
}
