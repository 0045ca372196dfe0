// Keys of the whole page, and the dialog that lists them.

import { setPose } from '../panels/pose'
import { page, store } from '../state/store'
import { button, h } from '../widgets/dom'

const KEYS: [string, string][] = [
  ['1 … 6', 'animate a mode, again to stop'],
  ['0', 'stop the animation'],
  ['H', 'home pose'],
  ['I F S T', 'isometric, front, side, top view'],
  ['arrows, + −', 'turn and zoom the 3-D view when it has the focus; step through plots'],
  ['Tab', 'next control; arrows move a slider'],
]
const VIEWS = { i: 'iso', f: 'front', s: 'side', t: 'top' } as const

export function showKeys(): void {
  const dialog = document.querySelector('dialog') ?? keysDialog()
  dialog.showModal()
}

function keysDialog(): HTMLDialogElement {
  const list = h('dl', {}, ...KEYS.flatMap(([key, words]) => [h('dt', {}, key), h('dd', {}, words)]))
  const licences = h('a', { href: './licenses.txt' }, 'their licences')
  const credits = h('p', { class: 'hint' }, 'Drawn with three.js and uPlot; ', licences, '.')
  const close = button('Close', () => dialog.close())
  const dialog = h('dialog', { 'aria-label': 'Keys' }, h('h2', {}, 'Keys'), list, credits, close)
  document.body.append(dialog)
  return dialog
}

export function listenToKeys(): void {
  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName)) return
    const key = event.key.toLowerCase()
    const mode = Number(key) - 1
    if (/^[1-6]$/.test(key)) store.set({ mode: page.mode === mode ? -1 : mode })
    else if (key === '0') store.set({ mode: -1 })
    else if (key === 'h' && page.design) setPose(page.design.home)
    else if (key in VIEWS) store.set({ view: VIEWS[key as keyof typeof VIEWS] })
    else if (key === '?') showKeys()
  })
}
