// Files from the page: tables as CSV, figures as SVG and PNG.

import { button, h } from './dom'

function save(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob)
  const link = h('a', { href: url, download: name })
  document.body.append(link)
  link.click()
  link.remove()
  setTimeout(() => URL.revokeObjectURL(url), 10_000)
}

export function saveText(name: string, text: string, type = 'text/plain'): void {
  save(name, new Blob([text], { type: `${type};charset=utf-8` }))
}

type Cell = string | number | null | undefined

function cell(value: Cell): string {
  if (value === null || value === undefined) return ''
  const text = String(value)
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text
}

export function saveCsv(name: string, head: string[], rows: Iterable<Cell[]>): void {
  const lines = [head.map(cell).join(',')]
  for (const row of rows) lines.push(row.map(cell).join(','))
  saveText(`${name}.csv`, `${lines.join('\r\n')}\r\n`, 'text/csv')
}

export function saveSvg(name: string, figure: SVGSVGElement): void {
  saveText(`${name}.svg`, new XMLSerializer().serializeToString(figure), 'image/svg+xml')
}

export function saveCanvas(name: string, canvas: HTMLCanvasElement): void {
  canvas.toBlob((blob) => blob && save(`${name}.png`, blob), 'image/png')
}

/** The figure drawn at twice its size. */
export async function savePng(name: string, figure: SVGSVGElement): Promise<void> {
  const { width, height } = figure.viewBox.baseVal
  const image = new Image()
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(new XMLSerializer().serializeToString(figure))}`
  await image.decode()
  const canvas = h('canvas', { width: 2 * width, height: 2 * height })
  canvas.getContext('2d')!.drawImage(image, 0, 0, 2 * width, 2 * height)
  saveCanvas(name, canvas)
}

/** Buttons that save a figure. */
export function figureButtons(name: () => string, what: string, figure: () => SVGSVGElement): HTMLElement {
  return h(
    'span',
    { class: 'downloads', role: 'group', 'aria-label': `Download ${what}` },
    button('PNG', () => void savePng(name(), figure()), {
      class: 'quiet',
      'aria-label': `${what} as PNG`,
      title: `${what} as PNG`,
    }),
    button('SVG', () => saveSvg(name(), figure()), {
      class: 'quiet',
      'aria-label': `${what} as SVG`,
      title: `${what} as SVG`,
    }),
  )
}

export function csvButton(what: string, write: () => void): HTMLButtonElement {
  return button('CSV', write, { class: 'quiet', 'aria-label': `${what} as CSV`, title: `${what} as CSV` })
}
