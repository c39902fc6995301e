/** The line to the server that is kept open for stopping alone, so that an emergency needs no new connection. */
import { getSession, type StopAnswer } from './api';

/** The server gives a sign of life every two seconds. */
const SILENT_MS = 5000;
const AGAIN_MS = 1000;

let socket: WebSocket | null = null;
let onAnswer: (answer: StopAnswer) => void = () => undefined;
let onOpen: () => void = () => undefined;

/** Who is told what the robots do after a stop, and that the line stands (again). */
export function hearStopLine(answered: (answer: StopAnswer) => void, opened: () => void): void {
  onAnswer = answered;
  onOpen = opened;
}

/** Open the line, and keep it open. @returns How to hang up. */
export function keepStopLine(): () => void {
  let ended = false;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const open = () => {
    const line = new WebSocket(new URL('/api/stop/line', window.location.href.replace(/^http/, 'ws')));
    const lost = () => {
      if (socket === line) socket = null;
      line.onclose = line.onmessage = null;
      line.close();
      clearTimeout(timer);
      if (!ended) timer = setTimeout(again, AGAIN_MS);
    };
    const heard = () => {
      clearTimeout(timer);
      timer = setTimeout(lost, SILENT_MS);
    };
    heard();
    line.onclose = lost;
    line.onmessage = (event: MessageEvent<string>) => {
      heard();
      if (socket !== line) {
        socket = line;
        onOpen();
      }
      const answer = JSON.parse(event.data) as Partial<StopAnswer>;
      if (answer.id !== undefined) onAnswer(answer as StopAnswer);
    };
  };
  // A server that was started anew knows this page again once it has asked who is signed in.
  const again = () => void getSession().then(open, () => (ended ? undefined : (timer = setTimeout(again, AGAIN_MS))));

  open();
  return () => {
    ended = true;
    clearTimeout(timer);
    socket?.close();
    socket = null;
  };
}

/** @returns Whether the line stands and took it. */
export function stopOnLine(targets: readonly string[], id: string): boolean {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify({ command: 'stop', targets, id }));
  return true;
}
