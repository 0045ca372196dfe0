// Opening a design: shown if it is one, otherwise its text with what is wrong.

import type { Design, FieldError } from '../state/answers'
import { ask, Refused } from '../state/api'
import { type Page, sourceKey, store } from '../state/store'

export const MOST_TEXT = 1024 * 1024

type Draft = (text: string, errors: FieldError[]) => void
let draft: Draft = () => undefined

/** Set the function that shows a text that is not a design. */
export function onDraft(show: Draft): void {
  draft = show
}

/** The change of the page's state when it shows a design. */
export function shown(text: string, design: Design): Partial<Page> {
  return { text, preset: '', changes: {}, design, described: sourceKey(text, {}), error: '' }
}

/** Ask the server for the design of a text. */
export function describe(text: string): Promise<Design> {
  return ask<Design>('api/design', { design: text, changes: {} })
}

/** Open a design, with the rest of a page's state. Resolves to whether the text is a design. */
export async function open(text: string, preset: string, rest: Partial<Page> = {}): Promise<boolean> {
  if (text.length > MOST_TEXT) {
    const message = `The file has ${text.length} characters; a design has at most ${MOST_TEXT}.`
    draft(text.slice(0, 2000), [{ key: '', message, line: 0 }])
    return false
  }
  try {
    const design = await describe(text)
    store.set({ ...shown(text, design), preset, box: design.box, pose: design.home, mode: -1, ...rest })
    return true
  } catch (error) {
    if (!(error instanceof Refused)) throw error
    draft(text, error.errors)
    return false
  }
}
