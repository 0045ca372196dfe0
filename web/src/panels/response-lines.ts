// Frequency responses as lines of a plot and as a table.

import type { Lines } from '../charts/line-figure'
import { span } from '../charts/scale'
import { categories, DASHES } from '../charts/theme'
import type { FrequencyResponse, OptionalNumber } from '../state/answers'

export const TURN = 2 * Math.PI

/** How the plots are shown. */
export interface Display {
  phase: boolean
  hertz: boolean
}

/** The unit of an output over that of the inputs; "1" if they are the same. */
function unitOf(response: FrequencyResponse, output: number): string {
  const over = response.output_units[output]
  const units = [...new Set(response.input_units)].map((u) =>
    u === over ? '1' : `${over}/${u.includes(' ') ? `(${u})` : u}`,
  )
  return units.join(' or ')
}

/** A phase, broken where it goes from one end of its range to the other. */
function unwrapped(phase: OptionalNumber[]): OptionalNumber[] {
  return phase.map((v, i) => (i > 0 && Math.abs((v ?? 0) - (phase[i - 1] ?? 0)) > 180 ? null : v))
}

/** The lines of one output, one for each input. */
export function responseLines(response: FrequencyResponse, output: number, { phase, hertz }: Display): Lines {
  const { omega, outputs, inputs } = response
  const name = outputs[output]
  const values = phase ? response.phase[output].map(unwrapped) : response.magnitude[output]
  const [min, max] = phase ? [-190, 190] : span(values, true)
  const at = omega.map((w) => (hertz ? w / TURN : w))
  const label = phase ? `${name}: phase, °` : `${name}, ${unitOf(response, output)}`
  return {
    title: `${name} (${response.output_units[output]}) ${phase ? 'phase' : 'amplitude'}`,
    x: { label: `frequency, ${hertz ? 'Hz' : 'rad/s'}`, min: at[0], max: at[at.length - 1], log: true },
    y: { label, min, max, log: !phase, every: phase ? 90 : undefined },
    at,
    series: inputs.map((input, i) => ({ name: input, colour: categories()[i], dash: DASHES[i], values: values[i] })),
    marks: response.modes.map((m) => ({ at: hertz ? m.omega / TURN : m.omega, name: m.name })),
  }
}

/** Head and rows of the table: amplitude and phase of each output by each input. */
export function responseTable(response: FrequencyResponse): [string[], (number | null)[][]] {
  const { omega, outputs, inputs, magnitude, phase } = response
  const pairs = outputs.flatMap((o) => inputs.flatMap((i) => [`${o}_by_${i}_amplitude`, `${o}_by_${i}_phase_deg`]))
  const rows = omega.map((w, n) => {
    const values = outputs.flatMap((_, o) => inputs.flatMap((__, i) => [magnitude[o][i][n], phase[o][i][n]]))
    return [w, w / TURN, ...values]
  })
  return [['omega_rad_s', 'frequency_hz', ...pairs], rows]
}
