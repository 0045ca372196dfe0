// Numbers as people read them.

/** Significant digits, with a thin exponent for the very large and small; a dash for what does not exist. */
export function sig(value: number | null | undefined, digits = 5): string {
  if (value === null || value === undefined || Number.isNaN(value)) return '–'
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞'
  if (value === 0) return '0'
  const size = Math.abs(value)
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(Math.min(digits, 4) - 1).split('e')
    return `${mantissa.replace('-', '−')}e${exponent.replace('+', '').replace('-', '−')}`
  }
  const text = size >= 10 ** digits ? String(Number(value.toPrecision(digits))) : value.toPrecision(digits)
  return text.replace(/^-/, '−')
}

/** A number for an input field: all the digits that matter, none of the rounding. */
export function field(value: number): string {
  const exact = Number(value.toPrecision(12))
  return Math.abs(exact) >= 1e6 ? exact.toExponential().replace('e+', 'e') : String(exact)
}

/** A number typed by a person: decimal comma, spaces and a typographic minus are all right. NaN if it is none. */
export function parsed(text: string): number {
  const clean = text
    .trim()
    .replace(/−/g, '-')
    .replace(/[\s_]/g, '')
    .replace(/^([^.]*),([^.,]*)$/, '$1.$2')
  return clean === '' ? Number.NaN : Number(clean)
}

export function percent(share: number | null): string {
  return share === null ? '–' : `${Math.round(100 * share) || 0} %`
}

export function duration(seconds: number): string {
  return seconds < 1 ? `${(1000 * seconds).toFixed(0)} ms` : `${seconds.toFixed(1)} s`
}

export function count(value: number): string {
  return value.toString().replace(/\B(?=(\d{3})+$)/g, '\u202f')
}
