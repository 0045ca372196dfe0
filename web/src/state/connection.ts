// Whether the server answers. While it does not, the page asks again and again, and says so.

import { answers, onLost } from './api'
import { page, store } from './store'

const EVERY = 1500 // ms between two trials

let waiting: (() => void) | null = null

/** Do something when the server answers again; only the last of these is done. */
export function whenBack(run: (() => void) | null): void {
  waiting = run
}

async function tryAgain(): Promise<void> {
  if (await answers()) {
    const held = waiting
    waiting = null
    store.set({ away: false })
    held?.()
  } else setTimeout(() => void tryAgain(), EVERY)
}

export function watchConnection(): void {
  onLost(() => {
    if (page.away) return
    store.set({ away: true })
    setTimeout(() => void tryAgain(), EVERY)
  })
}
