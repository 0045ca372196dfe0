// Controls of the page's options: each shows one, changes it, and follows it.

import { type KeyOf, type OptionKey, type Options, ruleOf } from '../state/options'
import { type Page, page, store } from '../state/store'
import { type Attributes, button, h, select } from './dom'
import { fault } from './fault'
import { field, parsed } from './format'

const put = (key: OptionKey, value: unknown) => store.set({ [key]: value } as Partial<Page>)

/** Keep a control what its option is. */
function follow(element: HTMLElement, key: OptionKey, show: () => void): void {
  element.dataset.option = key
  store.on([key], show)
  show()
}

/** A choice among the values of an option. */
export function choose<K extends KeyOf<string>>(
  key: K,
  label: string,
  values: readonly (readonly [Options[K] & string, string])[],
): HTMLSelectElement {
  const { element } = select<string>(label, values, String(page[key]), (value) => put(key, value))
  follow(element, key, () => {
    element.value = String(page[key])
  })
  return element
}

export interface NumberBox {
  input: HTMLInputElement
  wrong: HTMLElement // what is wrong with what was typed
}

/** A number to type. What is no number of the option is marked, and says what would be. */
export function numberBox(key: KeyOf<number>, label: string, attributes: Attributes = {}): NumberBox {
  const rule = ruleOf(key)
  const input = h('input', { type: 'text', class: 'number', inputmode: 'decimal', 'aria-label': label, ...attributes })
  const wrong = fault(input)
  const take = () => {
    const value = rule.read(String(parsed(input.value)))
    if (value === undefined) wrong.tell(`${label} is ${input.value.trim() || 'empty'}; it must be ${rule.words}.`)
    else put(key, value)
  }
  input.addEventListener('change', take)
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') take()
  })
  follow(input, key, () => {
    if (parsed(input.value) !== page[key]) input.value = field(page[key])
    wrong.tell('')
  })
  return { input, wrong: wrong.element }
}

/** A slider from 0 to 1. */
export function slider(key: KeyOf<number>, attributes: Attributes): HTMLInputElement {
  const input = h('input', { type: 'range', min: 0, max: 1, step: 'any', ...attributes })
  input.addEventListener('input', () => put(key, Number(input.value)))
  follow(input, key, () => {
    input.value = String(page[key])
  })
  return input
}

/** A button that is pressed or not. */
export function toggle(key: KeyOf<boolean>, text: string, attributes: Attributes = {}): HTMLButtonElement {
  const element = button(text, () => put(key, !page[key]), attributes)
  follow(element, key, () => element.setAttribute('aria-pressed', String(page[key])))
  return element
}

/** Put a name into the list of an option, or take it out. */
export function include(key: KeyOf<string[]>, name: string, on: boolean): void {
  const others = page[key].filter((other) => other !== name)
  put(key, on ? [...others, name] : others)
}
