import { expect, test, vi } from 'vitest'
import { type Model, Shared, type Traits } from '../src/notebook/model'
import { drawnSize, paceWords } from '../src/snapshot/mode'
import type { Snapshot } from '../src/state/answers'

/** A model as anywidget gives it, with what was sent to the kernel. */
class Fake implements Model {
  readonly sent: Record<string, unknown>[] = []
  readonly listeners: [string, () => void][] = []
  private changed: Record<string, unknown> = {}

  constructor(readonly state: Record<string, unknown>) {}

  get(name: string): unknown {
    return this.state[name]
  }

  set(name: string, value: unknown): void {
    this.changed[name] = this.state[name] = value
    this.tell(name)
  }

  save_changes(): void {
    this.sent.push(this.changed)
    this.changed = {}
  }

  /** As the kernel sends it. */
  take(state: Partial<Traits>): void {
    Object.assign(this.state, state)
    for (const name of Object.keys(state)) this.tell(name)
  }

  on(event: string, listener: () => void): void {
    this.listeners.push([event, listener])
  }

  off(event: string, listener: () => void): void {
    const at = this.listeners.findIndex(([name, one]) => name === event && one === listener)
    this.listeners.splice(at, 1)
  }

  private tell(name: string): void {
    for (const [event, listener] of [...this.listeners]) if (event === `change:${name}`) listener()
  }
}

const POSE = [0, 0, 0.5, 0, 0, 0]
const OTHER = [0, 0, 0.6, 0, 0, 10]
const at = (pose: number[]) => ({ pose }) as Snapshot
const model = () => new Fake({ _six: POSE, _snapshot: at(POSE), _refused: null, mode: null })

test('a pose that is asked for is answered, or refused, or neither yet', () => {
  const fake = model()
  const shared = new Shared(fake)
  expect([shared.answered, shared.refusal]).toEqual([true, ''])
  shared.put('_six', OTHER)
  expect(fake.sent).toEqual([{ _six: OTHER }])
  expect([shared.answered, shared.refusal]).toEqual([false, ''])
  fake.take({ _refused: { pose: OTHER, words: 'too far' } })
  expect([shared.answered, shared.refusal]).toEqual([false, 'too far'])
  shared.put('_six', POSE)
  expect([shared.answered, shared.refusal]).toEqual([true, ''])
  shared.put('_six', OTHER)
  fake.take({ _snapshot: at(OTHER), _refused: null })
  expect([shared.answered, shared.refusal]).toEqual([true, ''])
})

test('a refusal belongs to the pose that was refused', () => {
  const shared = new Shared(model())
  shared.put('_refused', { pose: OTHER, words: 'too far' })
  shared.put('_six', [0, 0, 0.7, 0, 0, 0])
  expect(shared.refusal).toBe('')
})

test('each view hears of changes until it leaves', () => {
  const fake = model()
  const [first, second] = [new Shared(fake), new Shared(fake)]
  const [one, two] = [vi.fn(), vi.fn()]
  first.on(['_six', 'mode'], one)
  second.on(['_six'], two)
  second.put('_six', OTHER)
  first.leave()
  fake.take({ _six: POSE, mode: 3 })
  expect([one.mock.calls.length, two.mock.calls.length]).toEqual([1, 2])
  expect(fake.listeners.length).toBe(1)
})

test('a mode is told how fast and how far it is drawn', () => {
  const platform = [
    [3, 4, 0],
    [0, 1, 0],
  ]
  const geometry = { platform }
  const s = { geometry, frequency: [0, 0.35, 7, null] } as unknown as Snapshot
  const drawn = drawnSize(s, 0.5)
  expect(drawn).toBeCloseTo(1.5, 12)
  const words = (mode: number, still = false) => paceWords(s, mode, drawn, still)
  expect(words(2)).toContain('Drawn at 0.7 swings a second, 10.0 times slower than the machine.')
  expect(words(2)).toContain('The greatest joint displacement drawn is 1500 mm.')
  expect(words(1)).toContain('0.7 swings a second, 2.00 times faster.')
  expect(words(0)).toContain('the machine itself does not swing back.')
  expect(words(3)).toContain('the machine itself does not swing back.')
  expect(words(2, true)).toContain('Drawn still')
})
