// Colours of the light and dark theme, for canvases and figures, and colours of categories.

/** Okabe and Ito's colours for categories, in an order in which neighbours differ most. */
const ON_LIGHT = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9']
/** The same hues, lighter for a dark background. */
const ON_DARK = ['#4d9bff', '#ff7f2a', '#1fc796', '#e08fc0', '#f2b632', '#8fd3ff']
export const categories = (): string[] => (theme().dark ? ON_DARK : ON_LIGHT)
/** Line styles that tell categories apart without colours: translations solid, rotations dashed. */
export const DASHES = [[], [], [], [6, 3], [6, 3], [6, 3]]
export const EXCEEDED = '#d55e00'

export interface Theme {
  dark: boolean
  paper: string
  text: string
  muted: string
  grid: string
  accent: string
}

export function theme(): Theme {
  const style = getComputedStyle(document.documentElement)
  const of = (name: string) => style.getPropertyValue(name).trim()
  return {
    dark: document.documentElement.dataset.theme === 'dark',
    paper: of('--panel'),
    text: of('--text'),
    muted: of('--muted'),
    grid: of('--grid'),
    accent: of('--accent'),
  }
}

const preferred = matchMedia('(prefers-color-scheme: dark)')
const listeners: (() => void)[] = []

export function onTheme(listener: () => void): void {
  listeners.push(listener)
}

function apply(dark: boolean): void {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light'
  for (const listener of listeners) listener()
}

/** Follow the system until a person chooses; the choice is kept on this computer. */
export function beginTheme(): void {
  const chosen = localStorage.getItem('theme')
  apply(chosen ? chosen === 'dark' : preferred.matches)
  preferred.addEventListener('change', () => {
    if (!localStorage.getItem('theme')) apply(preferred.matches)
  })
}

export function toggleTheme(): void {
  const dark = document.documentElement.dataset.theme !== 'dark'
  localStorage.setItem('theme', dark ? 'dark' : 'light')
  apply(dark)
}
