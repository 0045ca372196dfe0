// What the page says about itself: the server away, a link that is damaged, a file that was opened.

import { page, store } from '../state/store'
import { button, h, settled, status } from '../widgets/dom'

/** Says something for a few seconds. */
export type Say = (words: string) => void

const AWAY =
  'The server does not answer. The machine and its numbers are as it last answered; the page tries again by itself. ' +
  'Is `flexapod serve` still running?'

/** A line that says something for a few seconds. */
export function toast(): { element: HTMLElement; say: Say } {
  const element = status({ class: 'toast', hidden: true })
  const hide = settled(6000, () => {
    element.hidden = true
  })
  const say = (words: string) => {
    element.textContent = words
    element.hidden = false
    hide()
  }
  return { element, say }
}

/** A line that stays until it is closed. */
export function faultLine(): { element: HTMLElement; tell(words: string): void } {
  const words = h('span')
  const close = button('Close', () => {
    element.hidden = true
  })
  const element = h('p', { class: 'banner', role: 'alert', hidden: true, id: 'faults' }, words, close)
  return {
    element,
    tell(text) {
      words.textContent = text
      element.hidden = !text
    },
  }
}

/** A line for as long as the server does not answer. */
export function awayLine(say: Say): HTMLElement {
  const element = h('p', { class: 'banner', role: 'alert', hidden: true, id: 'away' }, AWAY)
  let away = false
  store.on(['away'], () => {
    element.hidden = !page.away
    if (away && !page.away) say('The server answers again.')
    away = page.away
  })
  return element
}
