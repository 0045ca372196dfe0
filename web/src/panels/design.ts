// The design: every number as a form, or its file as text. Errors stand at the field and at the line.

import type { Field } from '../state/answers'
import { page, store } from '../state/store'
import { button, h, select, status } from '../widgets/dom'
import { saveText } from '../widgets/download'
import { fileName } from '../widgets/format'
import { spring } from '../widgets/layout'
import { DesignEditor } from './design-editor'
import { DesignForm } from './design-form'
import { onDraft } from './opening'

const VIEWS = [
  ['form', 'Form'],
  ['toml', 'TOML text'],
] as const
const NO_DESIGN = 'This file is not a design yet; the machine shown is the one before. Correct the marked lines.'

export interface DesignPanel {
  element: HTMLElement
  fail(key: string, message: string): void
}

function save(): void {
  const { design } = page
  if (design) saveText(`${fileName(design.name)}.toml`, design.toml, 'application/toml')
}

/** `reveal` brings the panel to the front. */
export function designPanel(fields: Field[], reveal: () => void): DesignPanel {
  const form = new DesignForm(fields)
  const editor = new DesignEditor()
  const note = status({ class: 'hint' })
  const warnings = h('ul', { class: 'warnings' })
  const turn = (shown: 'form' | 'toml') => {
    view.set(shown)
    form.element.hidden = shown !== 'form'
    editor.element.hidden = shown !== 'toml'
  }
  const view = select('View of the design', VIEWS, 'form', turn)
  turn('form')
  onDraft((text, errors) => {
    editor.draft(text, errors)
    turn('toml')
    note.textContent = NO_DESIGN
    reveal()
  })
  store.on(['design'], () => {
    if (!editor.drafting) note.textContent = ''
    warnings.replaceChildren(...(page.design?.warnings ?? []).map((words) => h('li', {}, words)))
  })
  const download = button('Save TOML', save, { class: 'quiet' })
  const title = h('div', { class: 'bar' }, h('h2', {}, 'Design'), view.element, spring(), download)
  return {
    element: h('div', { id: 'design' }, title, note, warnings, form.element, editor.element),
    fail: (key, message) => form.fail(key, message),
  }
}
