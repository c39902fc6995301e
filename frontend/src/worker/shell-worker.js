/**
 * Keeps the page's own files on the device, so that it opens at once and says plainly when the server is out of
 * reach. Nothing that robots or people said is kept: requests below /api and the live stream are never touched.
 * The build puts version and files in.
 */
const CACHE = 'parley-shell-__SHELL_VERSION__';
const FILES = ['__SHELL_FILES__'];
const PAGE = '/';

self.addEventListener('install', (event) => {
  event.waitUntil(
    caches
      .open(CACHE)
      .then((cache) => cache.addAll([PAGE, '/icon.svg', '/manifest.webmanifest', ...FILES]))
      .then(() => self.skipWaiting()),
  );
});

self.addEventListener('activate', (event) => {
  event.waitUntil(
    caches
      .keys()
      .then((names) => Promise.all(names.filter((name) => name !== CACHE).map((name) => caches.delete(name))))
      .then(() => self.clients.claim()),
  );
});

/** The page comes from the server as long as that answers, so that it is never older than the server. */
async function page(request) {
  try {
    return await fetch(request);
  } catch (error) {
    const kept = await caches.match(PAGE);
    if (kept) return kept;
    throw error;
  }
}

/** A file's name says what is in it, so a kept one is never out of date. */
async function file(request) {
  return (await caches.match(request)) ?? fetch(request);
}

/** A robot waits for a person: said on the screen, unless a page is looked at, which says it itself. */
async function tell({ title, body, tag }) {
  const pages = await self.clients.matchAll({ type: 'window', includeUncontrolled: true });
  if (pages.some((one) => one.visibilityState === 'visible')) return;
  await self.registration.showNotification(title, { body, tag, icon: '/icon-192.png', requireInteraction: true });
}

/** The page that is open comes to the front, or a new one is opened. */
async function show() {
  const [first] = await self.clients.matchAll({ type: 'window', includeUncontrolled: true });
  await (first ? first.focus() : self.clients.openWindow(PAGE));
}

self.addEventListener('push', (event) => event.waitUntil(tell(event.data.json())));

self.addEventListener('notificationclick', (event) => {
  event.notification.close();
  event.waitUntil(show());
});

self.addEventListener('fetch', (event) => {
  const { request } = event;
  const { origin, pathname } = new URL(request.url);
  if (request.method !== 'GET' || origin !== self.location.origin) return;
  if (request.mode === 'navigate' && pathname === PAGE) event.respondWith(page(request));
  else if (FILES.includes(pathname) || pathname === '/icon.svg') event.respondWith(file(request));
});
