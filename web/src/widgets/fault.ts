// What is wrong with what was typed into a field, beside the field.

import { freshId, h } from './dom'

export interface Fault {
  element: HTMLElement
  /** Say what is wrong; '' if nothing is. */
  tell(words: string): void
}

export function fault(input: HTMLInputElement): Fault {
  const element = h('span', { class: 'wrong', role: 'alert', hidden: true, id: freshId('wrong') })
  const tell = (words: string) => {
    element.textContent = words
    element.hidden = !words
    input.setAttribute('aria-invalid', String(words !== ''))
    if (words) input.setAttribute('aria-describedby', element.id)
    else input.removeAttribute('aria-describedby')
  }
  return { element, tell }
}
