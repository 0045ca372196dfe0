// The page: header, pose and parameters, 3-D view, panels; and what asks the server when something changes.

import '../widgets/common.css'
import './style.css'
import { followPrinting } from '../charts/printing'
import { beginTheme, onTheme, theme } from '../charts/theme'
import { Animation } from '../machine3d/animation'
import { Scene } from '../machine3d/scene'
import { type DesignPanel, designPanel } from '../panels/design'
import { legsPanel } from '../panels/legs'
import { modesPanel } from '../panels/modes'
import { type ParametersPanel, parametersPanel } from '../panels/parameters'
import { posePanel } from '../panels/pose'
import { responsePanel } from '../panels/response'
import { timePanel } from '../panels/simulation'
import { viewPanel } from '../panels/view'
import { workspacePanel } from '../panels/workspace'
import { readout } from '../snapshot/readout'
import { toAddress } from '../state/address'
import type { Design, Snapshot, Start } from '../state/answers'
import { answers, get, Live, type Refused } from '../state/api'
import { watchConnection } from '../state/connection'
import { page, sourceKey, store } from '../state/store'
import { h, settled } from '../widgets/dom'
import { Result } from '../widgets/result'
import { tabs } from '../widgets/tabs'
import { header } from './header'
import { listenToKeys } from './keys'
import { awayLine, faultLine, toast } from './notices'
import { restore, type Tell } from './restore'

/** What shows errors at their fields, and what shows the machine at its pose. */
interface Built {
  panels: [ParametersPanel, DesignPanel]
  state: Result
  tell: Tell
}

/** Asks for the machine at its pose. */
const state = new Live<Snapshot>(
  'api/state',
  () => store.question(),
  (snapshot, asked) => {
    built?.state.shows(asked)
    store.set({ snapshot, error: '' })
  },
  (error) => failed(error),
)
let built: Built | null = null

function failed(error: Refused): void {
  store.set({ error: error.message })
  for (const { key, message } of error.errors) for (const panel of built?.panels ?? []) panel.fail(key, message)
}

/** Builds the page. */
function build(start: Start): Built {
  const { element, say } = toast()
  const faults = faultLine()
  const scene = new Scene(theme)
  const animation = new Animation(scene)
  const parameters = parametersPanel()
  const design = designPanel(start.fields, () => store.set({ tab: 'design' }))
  const refused = h('p', { class: 'refused', role: 'alert', hidden: true })
  const [modes, legs, results] = [modesPanel(animation), legsPanel(), readout()]
  const panels = tabs([
    ['modes', 'Modes', modes],
    ['legs', 'Legs', legs],
    ['workspace', 'Workspace', workspacePanel()],
    ['response', 'Response', responsePanel(animation)],
    ['time', 'Time', timePanel(animation)],
    ['design', 'Design', design.element],
  ])
  store.on(['snapshot'], () => page.snapshot && results.show(page.snapshot))
  const side = h('div', { class: 'side' }, posePanel(), parameters.element)
  const middle = h('div', { class: 'middle' }, results.element, viewPanel(scene), refused)
  const head = h('div', { class: 'head' }, header(start, say), awayLine(say), faults.element)
  document.body.append(head, h('main', {}, side, middle, panels), element)
  listenToKeys()
  store.on(['error'], () => {
    refused.textContent = page.error
    refused.hidden = !page.error
  })
  const question = () => store.question()
  const state = new Result({ question, ask: () => undefined, live: false }, [
    results.element,
    scene.element,
    modes,
    legs,
  ])
  return { panels: [parameters, design], state, tell: faults.tell }
}

/** Asks the server whenever the machine or its pose changes. */
function askTheServer(): void {
  const describe = new Live<Design>(
    'api/design',
    () => ({ design: page.text, changes: page.changes }),
    (design) => store.set({ design, described: sourceKey(page.text, page.changes) }),
    failed,
  )
  const undescribed = () => page.described !== sourceKey(page.text, page.changes)
  const changed = settled(120, describe.request)
  store.on(['pose', 'joint', 'text', 'changes'], state.request)
  store.on(['changes'], () => undescribed() && changed())
  store.on(['away'], () => {
    if (page.away || !page.text) return
    state.request()
    if (undescribed()) changed()
  })
}

/** Keeps the address of the page up to date. */
function keepAddress(): void {
  const write = async () => page.text && history.replaceState(null, '', `#${await toAddress(page)}`)
  store.onAny(settled(250, () => void write()))
}

/** What a page starts with, as soon as the server answers. */
async function startOf(): Promise<Start> {
  for (;;) {
    if (await answers()) return get<Start>('api/start')
    document.body.textContent = 'The server does not answer; the page tries again by itself.'
    await new Promise((resolve) => setTimeout(resolve, 1500))
  }
}

async function begin(): Promise<void> {
  beginTheme()
  followPrinting()
  const start = await startOf()
  document.body.textContent = ''
  built = build(start)
  const { tell } = built
  watchConnection()
  askTheServer()
  keepAddress()
  onTheme(() => page.snapshot && store.set({ snapshot: page.snapshot }))
  // By the event's own address: the page may have written its own over it since.
  addEventListener('hashchange', (event) => void restore(start, new URL(event.newURL).hash, tell))
  await restore(start, location.hash, tell)
}

void begin()
