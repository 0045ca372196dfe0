// A short simulation under a base motion: its form, the job, and its playback.

import type { Animation } from '../machine3d/animation'
import { floats } from '../state/api'
import { store } from '../state/store'
import { button, h } from '../widgets/dom'
import { csvButton, figureButtons } from '../widgets/download'
import { Runner } from '../widgets/job'
import { titleBar, toolBar } from '../widgets/layout'
import { Result } from '../widgets/result'
import { MotionForm } from './motion-form'
import { Playback } from './playback'

const HINT = 'The complete non-linear machine on a moving base, from rest at the pose.'

export function timePanel(animation: Animation): HTMLElement {
  const runner = new Runner()
  const form = new MotionForm()
  const playback = new Playback(animation)
  const question = () => ({ ...store.question(), ...form.question() })
  const run = async () => {
    if (form.why) return runner.fail(form.why)
    const asked = question()
    let words = ''
    const whole = await runner.run('time', asked, (message, data) => {
      if (message.type !== 'run') return
      words = message.words
      playback.take({ ...message, rows: floats(data) })
      result.shows(asked)
    })
    if (whole) runner.say(words)
  }
  const csv = csvButton('Simulation', () => playback.csv())
  const figures = figureButtons(
    () => 'simulation',
    'Simulation',
    () => playback.figure(),
  )
  const result = new Result(
    {
      question,
      ask: () => void run(),
      live: false,
      again: 'simulate again',
      changed: (stale) => stale && playback.leave(),
    },
    [playback.element],
    [csv, figures, playback.tools],
  )
  const start = button('Simulate', () => result.ask(), { class: 'primary', id: 'simulate' })
  return h(
    'div',
    { id: 'time' },
    titleBar('h2', 'Time simulation', csv, figures),
    h('p', { class: 'hint' }, HINT),
    toolBar(...form.elements, start),
    ...form.notes,
    runner.element,
    result.framed(),
  )
}
