/** Keep the page's own files on this device. Where that is not allowed, the page works without. */
export async function keepShell(): Promise<void> {
  if (!import.meta.env.PROD || !('serviceWorker' in navigator)) return;
  try {
    await navigator.serviceWorker.register('/shell-worker.js');
  } catch (error) {
    // Browsers refuse it where the certificate is not one they know, and in private windows.
    if (!(error instanceof DOMException || error instanceof TypeError)) throw error;
  }
}
