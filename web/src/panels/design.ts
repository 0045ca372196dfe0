// The design: every number as a form, or its file as text. Errors stand at the field and at the line.

import type { Field } from '../state/answers'
import { Refused } from '../state/api'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { button, h, status } from '../widgets/dom'
import { saveText } from '../widgets/download'
import { fileName } from '../widgets/format'
import { spring } from '../widgets/layout'
import { DesignEditor } from './design-editor'
import { DesignForm } from './design-form'
import { describe, onDraft } from './opening'

const VIEWS = [
  ['form', 'Form'],
  ['toml', 'TOML text'],
] as const
const NO_DESIGN = 'This file is not a design yet; the machine shown is the one before. Correct the marked lines.'

export interface DesignPanel {
  element: HTMLElement
  fail(key: string, message: string): void
}

/** Save the text on screen: a draft as it is written, otherwise the design with all its changes. */
async function save(draft: string | null, say: (words: string) => void): Promise<void> {
  if (draft !== null) {
    saveText('draft.toml', draft, 'application/toml')
    return say('Saved as draft.toml, as it is written; it is not the machine shown.')
  }
  try {
    const { name, toml } = await describe(page.text, page.changes)
    saveText(`${fileName(name)}.toml`, toml, 'application/toml')
    say(`Saved as ${fileName(name)}.toml.`)
  } catch (error) {
    if (!(error instanceof Refused)) throw error
    say(`Not saved. ${error.message}`)
  }
}

/** `reveal` brings the panel to the front. */
export function designPanel(fields: Field[], reveal: () => void): DesignPanel {
  const form = new DesignForm(fields)
  const editor = new DesignEditor()
  const note = status({ class: 'hint' })
  const warnings = h('ul', { class: 'warnings' })
  const turn = () => {
    form.element.hidden = page.design_view !== 'form'
    editor.element.hidden = page.design_view !== 'toml'
  }
  const say = (words: string) => {
    note.textContent = words
  }
  store.on(['design_view'], turn)
  turn()
  onDraft((text, errors) => {
    editor.show(text, errors)
    store.set({ design_view: 'toml' })
    say(NO_DESIGN)
    reveal()
  })
  store.on(['design'], () => {
    if (editor.draft === null) say('')
    warnings.replaceChildren(...(page.design?.warnings ?? []).map((words) => h('li', {}, words)))
  })
  const text = () => (page.design_view === 'toml' ? editor.draft : null)
  const download = button('Save TOML', () => void save(text(), say), { class: 'quiet' })
  const view = choose('design_view', 'View of the design', VIEWS)
  const title = h('div', { class: 'bar' }, h('h2', {}, 'Design'), view, spring(), download)
  return {
    element: h('div', { id: 'design' }, title, note, warnings, form.element, editor.element),
    fail: (key, message) => form.fail(key, message),
  }
}
