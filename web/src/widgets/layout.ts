// Headings with tools, and tables of data.

import { type Child, h } from './dom'

/** Pushes what follows it in a bar to the right. */
export const spring = (): HTMLElement => h('span', { class: 'spring' })

/** A heading with tools at its right. */
export function titleBar(level: 'h2' | 'h3', title: string, ...tools: Child[]): HTMLElement {
  return h('div', { class: 'bar' }, h(level, {}, title), spring(), ...tools)
}

/** A row of controls. */
export function toolBar(...tools: Child[]): HTMLElement {
  return h('div', { class: 'bar tools' }, ...tools)
}

export interface Column {
  name: string
  unit?: string | HTMLElement
}

/** A table of data. Its caption is for screen readers. */
export function dataTable(id: string, caption: string, columns: Column[], body: HTMLElement): HTMLElement {
  const unitOf = ({ unit }: Column) => (typeof unit === 'string' ? h('small', {}, ` ${unit}`) : unit)
  const heads = columns.map((column) => h('th', { scope: 'col' }, column.name, unitOf(column)))
  return h(
    'table',
    { class: 'data', id },
    h('caption', { class: 'hidden' }, caption),
    h('thead', {}, h('tr', {}, ...heads)),
    body,
  )
}

/** A table row: a heading cell, then cells of data. */
export function row(heading: Child, cells: Child[]): HTMLTableRowElement {
  return h('tr', {}, h('th', { scope: 'row' }, heading), ...cells.map((cell) => h('td', {}, cell)))
}
