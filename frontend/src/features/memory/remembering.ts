/** Names of memories, where they came from, and bringing one back that was forgotten. */
import { deleteMemory, putMemory, type MemoryBody } from '@/live/api';
import { fetchPicture } from '@/live/picture';
import type { MemoryItem } from '@/live/types';

const NAME_WORDS = 6;
const NAME_LETTERS = 80;

/** A name for something that was given none: its first words. */
export function nameFor(text: string): string {
  const words = text.toLowerCase().match(/[\p{L}\p{N}]+/gu) ?? [];
  return words.slice(0, NAME_WORDS).join('_').slice(0, NAME_LETTERS);
}

export type Source = { kind: 'none' | 'operator' } | { kind: 'someone' | 'deed'; who: string };

/** Where a memory came from: a person, a robot, or what a robot was doing. */
export function sourceOf(item: MemoryItem): Source {
  const [who = '', deed = ''] = item.source.split('/');
  if (who === '') return { kind: 'none' };
  if (deed !== '') return { kind: 'deed', who };
  return who === 'operator' ? { kind: 'operator' } : { kind: 'someone', who };
}

/** How it is known; of old memories that is not known. */
export const wayOf = (item: MemoryItem): 'told' | 'seen' | 'concluded' | null => item.way || null;

/** What is needed to remember it again. */
async function bodyOf(item: MemoryItem): Promise<MemoryBody> {
  const data = item.type === 'image' ? await fetchPicture(item.data) : item.data;
  return { type: item.type, data, info: item.info, scope: item.scope, again: true };
}

/** Forget one memory. @returns How to bring it back. @throws ApiError It could not be forgotten. */
export async function forget(item: MemoryItem): Promise<() => Promise<unknown>> {
  const body = await bodyOf(item);
  await deleteMemory(item.name, item.scope);
  return () => putMemory(item.name, body);
}
