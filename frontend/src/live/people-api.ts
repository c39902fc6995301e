/** Requests about people, devices and passkeys. */
import { request } from './api';
import type { CodeInfo, MyAccount, PeopleInfo, Role, SessionInfo } from './types';

const part = encodeURIComponent;

export const getPeople = () => request<PeopleInfo>('GET', 'people');
export const addPerson = (name: string, role: Role, password: string) =>
  request<unknown>('POST', 'people', { name, role, password });
export const changePerson = (name: string, change: { role?: Role; password?: string; disabled?: boolean }) =>
  request<unknown>('PUT', `people/${part(name)}`, change);
export const removePerson = (name: string) => request<unknown>('DELETE', `people/${part(name)}`);
export const revokeDevice = (id: string) => request<unknown>('DELETE', `people/devices/${part(id)}`);
export const makeCode = (role: Role) => request<CodeInfo>('POST', 'people/code', { role });

export const getMe = () => request<MyAccount>('GET', 'me');
export const changeMyPassword = (old: string, wanted: string) => request<unknown>('PUT', 'me/password', { old, new: wanted });
export const closeMyDevice = (id: string) => request<unknown>('DELETE', `me/devices/${part(id)}`);
export const closeAllMyDevices = () => request<unknown>('DELETE', 'me/devices');
export const removePasskey = (id: string) => request<unknown>('DELETE', `me/passkeys/${part(id)}`);

interface Question {
  id: string;
  options: Record<string, unknown>;
}

/**
 * Make a passkey on this device and have the server keep it.
 * @throws DOMException The person or the browser did not want to.
 */
export async function makePasskey(name: string): Promise<void> {
  const { id, options } = await request<Question>('POST', 'me/passkeys/options');
  const publicKey = PublicKeyCredential.parseCreationOptionsFromJSON(options as unknown as PublicKeyCredentialCreationOptionsJSON);
  const made = (await navigator.credentials.create({ publicKey })) as PublicKeyCredential;
  await request('POST', 'me/passkeys', { id, name, credential: made.toJSON() as unknown });
}

/**
 * Sign in with a passkey that this device has.
 * @throws DOMException The person or the browser did not want to.
 */
export async function enterWithPasskey(): Promise<SessionInfo> {
  const { id, options } = await request<Question>('POST', 'session/passkey/options');
  const publicKey = PublicKeyCredential.parseRequestOptionsFromJSON(options as unknown as PublicKeyCredentialRequestOptionsJSON);
  const found = (await navigator.credentials.get({ publicKey })) as PublicKeyCredential;
  return request<SessionInfo>('POST', 'session/passkey', { id, credential: found.toJSON() as unknown });
}

/** Whether this browser has passkeys at all. */
export const browserHasPasskeys = () => 'PublicKeyCredential' in window && 'parseRequestOptionsFromJSON' in PublicKeyCredential;
