/** Problems in order, and their steps in words. Plain functions. */
import type { Incident } from '@/live/types';
import { inWords, sentence } from '@/ui/words';

/** What was fetched and what came live since, each once, newest first. */
export function merged(fetched: readonly Incident[], live: readonly Incident[], robot: string): Incident[] {
  const all = new Map([...fetched, ...live].map((incident) => [incident.id, incident]));
  return [...all.values()]
    .filter((incident) => robot === '' || incident.robot === robot)
    .sort((a, b) => b.opened_unix_ms - a.opened_unix_ms);
}

/** What the step that went wrong was for; of records of old only what was called. */
export function stepInWords(incident: Incident): string {
  if (incident.label) return sentence(incident.label);
  const [[name, body] = ['', {}]] = Object.entries(incident.step);
  const reason: unknown = (body as { reason?: unknown }).reason;
  return typeof reason === 'string' && reason !== '' ? sentence(reason) : inWords(name);
}
