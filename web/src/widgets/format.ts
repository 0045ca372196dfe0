// Numbers as people read them.

/** A number with significant digits, with an exponent if very large or small; a dash if there is no number. */
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

/** A number for an input field, with up to twelve digits. */
export function field(value: number): string {
  const exact = Number(value.toPrecision(12))
  return Math.abs(exact) >= 1e6 ? exact.toExponential().replace('e+', 'e') : String(exact)
}

/** The number that a person typed, with decimal comma, spaces or a typographic minus; NaN if it is not a number. */
export function parsed(text: string): number {
  const clean = text
    .trim()
    .replace(/−/g, '-')
    .replace(/[\s_]/g, '')
    .replace(/^([^.]*),([^.,]*)$/, '$1.$2')
  return clean === '' ? Number.NaN : Number(clean)
}

/** A name without the characters that file names should not have. */
export function fileName(name: string): string {
  return name.replace(/[^\w.-]+/g, '-')
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
