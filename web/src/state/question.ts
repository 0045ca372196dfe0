// Whether an answer is still that of the page's question, and in what they differ.

import type { Question } from './store'

const NAMES: Record<string, string> = {
  design: 'design',
  changes: 'design',
  joint: 'joint model',
  pose: 'pose',
  box: 'pose box',
}

/** The parts in which two questions differ, in words, each once. None: it is the same question. */
export function differences(a: Question, b: Question): string[] {
  const keys = new Set([...Object.keys(a), ...Object.keys(b)])
  const differ = [...keys].filter((key) => a[key] !== b[key] && JSON.stringify(a[key]) !== JSON.stringify(b[key]))
  return [...new Set(differ.map((key) => NAMES[key] ?? 'settings'))]
}

/** "pose", "design and pose", "design, pose and settings". */
export function listed(words: string[]): string {
  return words.length < 2 ? words.join() : `${words.slice(0, -1).join(', ')} and ${words[words.length - 1]}`
}
