// The colours of a page or of a part of one, which its style sheet has, and colours with a meaning.

export const EXCEEDED = '#d55e00'

export interface Theme {
  dark: boolean
  paper: string
  text: string
  muted: string
  grid: string
  accent: string
}

/** The theme of what has `data-theme` and the variables of the style sheet. */
export function themeOf(root: HTMLElement): Theme {
  const style = getComputedStyle(root)
  const of = (name: string) => style.getPropertyValue(name).trim()
  return {
    dark: root.dataset.theme === 'dark',
    paper: of('--panel'),
    text: of('--text'),
    muted: of('--muted'),
    grid: of('--grid'),
    accent: of('--accent'),
  }
}
