// Opening a design: shown if it is one, otherwise its text with what is wrong.

import type { Design, FieldError } from '../state/answers'
import { ask, Refused, Unreachable } from '../state/api'
import { whenBack } from '../state/connection'
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

/** Ask the server for the design of a text, with changes to it. */
export function describe(text: string, changes: Record<string, unknown> = {}): Promise<Design> {
  return ask<Design>('api/design', { design: text, changes })
}

/** `waiting`: for the server to answer again; `superseded`: another design was opened meanwhile. */
export type Outcome = 'shown' | 'refused' | 'waiting' | 'superseded'

let opened = 0

/** How many designs were opened so far: what is meant for the last one asks whether it still is. */
export const openings = (): number => opened

/** Open a design, with the rest of a page's state. */
export async function open(text: string, preset: string, rest: Partial<Page> = {}): Promise<Outcome> {
  const mine = ++opened
  whenBack(null)
  if (text.length > MOST_TEXT) {
    const message = `The file has ${text.length} characters; a design has at most ${MOST_TEXT}.`
    draft(text.slice(0, 2000), [{ key: '', message, line: 0 }])
    return 'refused'
  }
  try {
    const design = await describe(text)
    if (mine !== opened) return 'superseded'
    const start = { box: design.box, pose: design.home, mode: -1, view: 'iso' }
    store.set({ ...shown(text, design), preset, ...start, ...rest })
    return 'shown'
  } catch (error) {
    if (!(error instanceof Refused)) throw error
    if (mine !== opened) return 'superseded'
    if (error instanceof Unreachable) {
      whenBack(() => void open(text, preset, rest))
      return 'waiting'
    }
    draft(text, error.errors)
    return 'refused'
  }
}
