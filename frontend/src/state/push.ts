/** Being called on this device while the page is closed, where the browser can. */
import { dropPush, getPushKey, putPush } from '@/live/api';

const READY_MS = 3000;

/** What is kept in the browser: it has a worker only where the address is one that it trusts. */
async function registration(): Promise<ServiceWorkerRegistration | null> {
  if (!('serviceWorker' in navigator && 'PushManager' in window && 'Notification' in window)) return null;
  const late = new Promise<null>((resolve) => setTimeout(resolve, READY_MS, null));
  return Promise.race([navigator.serviceWorker.ready, late]);
}

export type Calling = 'on' | 'off' | 'impossible';

/** Whether this device is called. */
export async function callingNow(): Promise<Calling> {
  const kept = await registration();
  if (!kept) return 'impossible';
  return (await kept.pushManager.getSubscription()) ? 'on' : 'off';
}

/**
 * Have this device called. The browser asks the person.
 * @returns Whether it is; not where the person or the browser does not want it.
 */
export async function beginCalling(): Promise<boolean> {
  const kept = await registration();
  if (!kept || (await Notification.requestPermission()) !== 'granted') return false;
  const { key } = await getPushKey();
  const subscription = await kept.pushManager
    .subscribe({ userVisibleOnly: true, applicationServerKey: key })
    .catch((error: unknown) => {
      if (error instanceof DOMException) return null; // its maker's service is out of reach, or there is none
      throw error;
    });
  const { endpoint, keys } = subscription?.toJSON() ?? {};
  if (!endpoint || !keys) return false;
  await putPush({ endpoint, p256dh: keys.p256dh ?? '', auth: keys.auth ?? '' });
  return true;
}

/** Call it no more. */
export async function endCalling(): Promise<void> {
  const subscription = await (await registration())?.pushManager.getSubscription();
  if (!subscription) return;
  await subscription.unsubscribe();
  await dropPush(subscription.endpoint);
}
