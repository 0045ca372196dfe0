// The light and dark theme of the whole page, and colours of categories.

import type { Rgb } from './colourmaps'
import { type Theme, themeOf } from './look'

/** Okabe and Ito's colours for categories, the last three darker so that lines show on white, neighbours far apart. */
export const ON_LIGHT = ['#0072b2', '#d55e00', '#009e73', '#b8608f', '#b57a00', '#2f90c9']
/** The same hues, lighter for a dark background. */
export const ON_DARK = ['#4d9bff', '#ff7f2a', '#1fc796', '#e08fc0', '#f2b632', '#8fd3ff']
export const categories = (): string[] => (theme().dark ? ON_DARK : ON_LIGHT)
/** Line styles that tell categories apart without colours: translations solid, rotations dashed. */
export const DASHES = [[], [], [], [7, 3], [2, 2], [9, 3, 2, 3]]

export const theme = (): Theme => themeOf(document.documentElement)

/** The grey of poses beyond the limits. */
export const beyond = (): Rgb => (theme().dark ? [88, 98, 110] : [201, 206, 213])

const preferred = matchMedia('(prefers-color-scheme: dark)')
const listeners: (() => void)[] = []

export function onTheme(listener: () => void): void {
  listeners.push(listener)
}

let dark = false
let paper = false

function apply(chosen = dark): void {
  dark = chosen
  document.documentElement.dataset.theme = dark && !paper ? 'dark' : 'light'
  for (const listener of listeners) listener()
}

/** While the page is printed, it is light. */
export function usePaper(on: boolean): void {
  paper = on
  apply()
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
  localStorage.setItem('theme', dark ? 'light' : 'dark')
  apply(!dark)
}
