/** The log as a table for other programs. Plain functions. */
import type { LogLine } from '@/live/types';

const COLUMNS = ['number', 'time', 'effect', 'outcome', 'robot', 'text'] as const;

/** What a table program would take for a formula is marked as text. */
const cell = (value: string) => `"${(/^[=+\-@\t\r]/.test(value) ? `'${value}` : value).replaceAll('"', '""')}"`;

/** Lines as CSV (RFC 4180), oldest first. */
export function tableOf(lines: readonly LogLine[]): string {
  const rows = lines.toReversed().map((line) => ({ ...line, number: String(line.number), time: new Date(line.unix_ms).toISOString(), robot: line.robot ?? '' }));
  return [COLUMNS.map(cell), ...rows.map((row) => COLUMNS.map((name) => cell(row[name])))].map((row) => `${row.join(',')}\r\n`).join('');
}

/** Give a file to the person. */
export function save(text: string, name: string): void {
  const address = URL.createObjectURL(new Blob([`\uFEFF${text}`], { type: 'text/csv;charset=utf-8' }));
  Object.assign(document.createElement('a'), { href: address, download: name }).click();
  URL.revokeObjectURL(address);
}
