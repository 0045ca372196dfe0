// Printing: the page is drawn for light paper, and plots of fixed size as figures that fit it.

import { flushFrames } from '../widgets/dom'
import { usePaper } from './theme'

interface Printed {
  begin(): void
  end(): void
}

const parts: Printed[] = []
let printing = false

/** What a part of the page does before and after it is printed. */
export function onPrint(begin: () => void, end: () => void): void {
  parts.push({ begin, end })
}

function turn(on: boolean): void {
  if (on === printing) return
  printing = on
  usePaper(on)
  for (const part of parts) on ? part.begin() : part.end()
  flushFrames() // there is no frame between here and the paper
}

/** Follow the browser, which tells of printing by events, and by the medium. */
export function followPrinting(): void {
  const medium = matchMedia('print')
  addEventListener('beforeprint', () => turn(true))
  addEventListener('afterprint', () => turn(false))
  medium.addEventListener('change', () => turn(medium.matches))
}
