// Colour maps that people with colour blindness can read too.

const CIVIDIS =
  // J. R. Nunez and others, 2018
  ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74', '#c3b369', '#e1cc55', '#fee838']
const VIRIDIS = [
  '#440154',
  '#482878',
  '#3e4989',
  '#31688e',
  '#26828e',
  '#1f9e89',
  '#35b779',
  '#6ece58',
  '#b5de2b',
  '#fde725',
]
const SIGNED = ['#08519c', '#3182bd', '#6baed6', '#bdd7e7', '#d9d9d9', '#fdd0a2', '#fd8d3c', '#e6550d', '#a63603']

export type Rgb = [number, number, number]
export type ColourMap = (t: number) => Rgb

/** A colour map through samples; t from 0 to 1. */
function interpolated(samples: string[]): ColourMap {
  const rgb = samples.map((s) => [1, 3, 5].map((i) => Number.parseInt(s.slice(i, i + 2), 16)))
  return (t) => {
    const at = Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), 1) * (rgb.length - 1)
    const i = Math.min(Math.floor(at), rgb.length - 2)
    return [0, 1, 2].map((c) => Math.round(rgb[i][c] + (at - i) * (rgb[i + 1][c] - rgb[i][c]))) as Rgb
  }
}

export const cividis = interpolated(CIVIDIS)
export const viridis = interpolated(VIRIDIS)
/** Blue over grey to orange, for signed numbers. */
export const signed = interpolated(SIGNED)

export const css = ([r, g, b]: Rgb): string => `rgb(${r},${g},${b})`
