/** All words of the page. A language is a folder here, with a file for each part, or comes with the page. */
import i18next from 'i18next';
import { initReactI18next } from 'react-i18next';

import * as en from './en';

const files = import.meta.glob<Record<string, unknown>>(['./*/*.json'], { eager: true, import: 'default' });

type Words = Record<string, Record<string, unknown>>;
export const languages: Readonly<Record<string, Words>> = JSON.parse(document.getElementById('languages')?.textContent ?? '{}') as Record<string, Words>;
for (const [path, words] of Object.entries(files)) {
  const [, language = '', part = ''] = path.replace('.json', '').split('/');
  (languages as Record<string, Words>)[language] = { ...languages[language], [part]: words };
}

/** A language's name in itself. */
export function nameOfLanguage(language: string): string {
  const name = new Intl.DisplayNames([language], { type: 'language' }).of(language) ?? language;
  return name.charAt(0).toLocaleUpperCase(language) + name.slice(1);
}

/** Begin with a language. */
export async function startWords(language: string): Promise<void> {
  await i18next.use(initReactI18next).init({
    resources: languages,
    lng: language,
    fallbackLng: 'en',
    ns: Object.keys(en),
    defaultNS: 'common',
    interpolation: { escapeValue: false }, // React escapes
    returnNull: false,
    showSupportNotice: false,
  });
}
