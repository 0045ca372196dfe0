// Shows what an address says, or what the server was started with, and says what is wrong in the address.

import { describe, open, openings } from '../panels/opening'
import { fromAddress } from '../state/address'
import type { Start } from '../state/answers'
import { Refused, Unreachable } from '../state/api'
import { whenBack } from '../state/connection'
import { page, store } from '../state/store'

const FIRST = 'motion-base'

export type Tell = (words: string) => void

let latest = 0

export async function restore(start: Start, hash: string, tell: Tell): Promise<void> {
  const mine = ++latest
  const superseded = () => mine !== latest // by another address, whose state this one must not touch
  const { presets } = start
  const { state, faults } = await fromAddress(hash, presets)
  if (superseded()) return
  const { text: said, preset: name, changes, ...rest } = state
  const first = start.start ?? { name: FIRST, text: presets[FIRST] }
  const text = said ?? first.text
  const preset = said === undefined ? (presets[first.name] === text ? first.name : '') : (name ?? '')
  const outcome = await open(text, preset, rest)
  if (outcome === 'waiting') whenBack(() => void restore(start, hash, tell))
  if (outcome === 'shown') faults.push(...(await change(changes ?? {})))
  else if (outcome === 'refused' && !page.design) {
    await open(presets[FIRST], FIRST)
    await open(text, preset) // again, to show its errors beside that machine
  }
  if (superseded()) return
  tell(faults.length ? `The link is damaged: ${faults.join('; ')}. The rest of it is shown.` : '')
}

/** Make the changes of an address to the design that is shown, unless another was opened meanwhile, or say why not. */
async function change(changes: Record<string, unknown>): Promise<string[]> {
  if (!Object.keys(changes).length) return []
  const mine = openings()
  try {
    await describe(page.text, changes)
  } catch (error) {
    if (!(error instanceof Refused)) throw error
    if (!(error instanceof Unreachable))
      return [`its changes to the design are refused (${error.message}) and left out`]
  }
  if (mine === openings()) store.set({ changes })
  return []
}
