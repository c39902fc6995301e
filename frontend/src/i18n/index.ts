/** All words of the page. Each part has a file per language; a test compares them. */
import i18next from 'i18next';
import { initReactI18next } from 'react-i18next';

import * as en from './en';
import * as et from './et';

export const languages = { en, et };

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
