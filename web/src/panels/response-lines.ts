// Frequency responses as lines of a plot and as a table.

import type { Lines } from '../charts/line-figure'
import { span } from '../charts/scale'
import { categories, DASHES } from '../charts/theme'
import type { FrequencyResponse } from '../state/answers'

export const TURN = 2 * Math.PI

/** How the plots are shown. */
export interface Display {
  phase: boolean
  hertz: boolean
}

/** The unit of an output over that of the inputs; "1" if they are the same. */
function unitOf(response: FrequencyResponse, output: number): string {
  const units = [...new Set(response.input_units)].map((u) => `${response.output_units[output]}/${u}`)
  return units.map((unit) => unit.replace(/^(\S+)\/\1$/, '1')).join(' or ')
}

/** The lines of one output, one for each input. */
export function responseLines(response: FrequencyResponse, output: number, { phase, hertz }: Display): Lines {
  const { omega, outputs, inputs } = response
  const name = outputs[output]
  const values = (phase ? response.phase : response.magnitude)[output]
  const [min, max] = phase ? [-190, 190] : span(values, true)
  const at = omega.map((w) => (hertz ? w / TURN : w))
  const label = phase ? `${name}: phase, °` : `${name}, ${unitOf(response, output)}`
  return {
    title: `${name} (${response.output_units[output]}) ${phase ? 'phase' : 'amplitude'}`,
    x: { label: `frequency, ${hertz ? 'Hz' : 'rad/s'}`, min: at[0], max: at[at.length - 1], log: true },
    y: { label, min, max, log: !phase },
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
