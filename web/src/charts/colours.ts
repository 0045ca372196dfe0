// Colour maps that people with colour-blindness read too, and the colours of the theme for canvases.

/** Samples of cividis (J. R. Nunez and others, 2018), of viridis, and of a blue-white-orange pair for signed numbers. */
const CIVIDIS = [
  '#00224e',
  '#123570',
  '#3b496c',
  '#575d6d',
  '#707173',
  '#8a8678',
  '#a59c74',
  '#c3b369',
  '#e1cc55',
  '#fee838',
]
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

export type Map = (t: number) => [number, number, number]

function interpolated(stops: string[]): Map {
  const rgb = stops.map((s) => [1, 3, 5].map((i) => Number.parseInt(s.slice(i, i + 2), 16)))
  return (t) => {
    const at = Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), 1) * (rgb.length - 1)
    const i = Math.min(Math.floor(at), rgb.length - 2)
    return [0, 1, 2].map((c) => Math.round(rgb[i][c] + (at - i) * (rgb[i + 1][c] - rgb[i][c]))) as [
      number,
      number,
      number,
    ]
  }
}

export const cividis = interpolated(CIVIDIS)
export const viridis = interpolated(VIRIDIS)
export const signed = interpolated(SIGNED)
export const css = ([r, g, b]: number[]): string => `rgb(${r},${g},${b})`

/** Okabe and Ito's colours for categories, in an order in which neighbours differ most. */
const ON_LIGHT = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9']
/** The same hues, lighter where they would sink into a dark ground. */
const ON_DARK = ['#4d9bff', '#ff7f2a', '#1fc796', '#e08fc0', '#f2b632', '#8fd3ff']
export const categories = (): string[] => (theme().dark ? ON_DARK : ON_LIGHT)
/** Second mark of a category for those who see no colours: translations drawn through, rotations dashed. */
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
