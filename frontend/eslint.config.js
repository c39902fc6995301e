import js from '@eslint/js';
import checkFile from 'eslint-plugin-check-file';
import i18next from 'eslint-plugin-i18next';
import a11y from 'eslint-plugin-jsx-a11y';
import hooks from 'eslint-plugin-react-hooks';
import ts from 'typescript-eslint';

/** Imports point one way: live, state, i18n and ui are shared; features use those and no other feature; app uses all. */
const closed = (folder, patterns, message) => ({
  files: [`src/${folder}/**/*.{ts,tsx}`],
  rules: { 'no-restricted-imports': ['error', { patterns: [{ group: ['../*', ...patterns], message }] }] },
});
const upwards = ['@/features/*', '@/app/*'];
const direction = [
  closed('features', upwards, 'Features do not know each other: move what both need to src/ui, src/live or src/state.'),
  closed('ui', upwards, 'What is shared does not know who uses it.'),
  closed('state', [...upwards, '@/ui/*'], 'What is shared does not know who uses it.'),
  closed('i18n', [...upwards, '@/ui/*', '@/state/*', '@/live/*'], 'Words know nothing else.'),
  closed('live', [...upwards, '@/ui/*', '@/state/*', '@/i18n/*'], 'The connection knows nothing else.'),
];

export default ts.config(
  { ignores: ['node_modules', 'src/live/api-types.ts', 'screenshots'] },
  js.configs.recommended,
  ...ts.configs.strict,
  ...direction,
  {
    plugins: { 'check-file': checkFile },
    rules: {
      complexity: ['error', 12],
      'max-lines': ['error', { max: 250 }],
      'no-console': 'error',
      eqeqeq: 'error',
      'check-file/filename-naming-convention': [
        'error',
        { '**/*.{ts,tsx,js,mjs}': 'KEBAB_CASE' },
        { ignoreMiddleExtensions: true },
      ],
    },
  },
  { files: ['src/**/*.{ts,tsx}'], plugins: { 'react-hooks': hooks }, rules: hooks.configs.recommended.rules },
  {
    files: ['src/**/*.tsx'],
    ignores: ['**/*.test.tsx'],
    plugins: { i18next },
    extends: [a11y.flatConfigs.recommended],
    rules: {
      'jsx-a11y/no-autofocus': 'off', // opened boxes take the focus on purpose
      'i18next/no-literal-string': ['error', { mode: 'jsx-only', 'jsx-attributes': { include: ['aria-label', 'title', 'placeholder', 'alt', 'label'] } }],
    },
  },
  { files: ['src/worker/**'], languageOptions: { globals: { self: 'readonly', caches: 'readonly', fetch: 'readonly', URL: 'readonly' } } },
  { files: ['scripts/**', 'e2e/**', '*.ts', '*.js'], languageOptions: { globals: { process: 'readonly', console: 'readonly', setTimeout: 'readonly', URL: 'readonly', fetch: 'readonly', document: 'readonly', window: 'readonly', navigator: 'readonly', performance: 'readonly', requestAnimationFrame: 'readonly' } }, rules: { 'no-console': 'off' } },
);
