import { readdirSync } from 'node:fs';
import jsxA11y from 'eslint-plugin-jsx-a11y';
import reactHooks from 'eslint-plugin-react-hooks';
import globals from 'globals';
import tseslint from 'typescript-eslint';

const kLayers = ['language', 'units', 'api', 'ui', 'charts', 'features', 'kiosk'];

/** Who may import whom: a folder of src may name only the layers given, and nothing by way of '..'. */
function layer(name, allowed, extra = []) {
  const refused = kLayers.filter((other) => !allowed.includes(other));
  return {
    files: [`src/${name}/**/*.{ts,tsx}`],
    rules: {
      'no-restricted-imports': [
        'error',
        {
          patterns: [
            { regex: '^\\.\\./', message: 'Name another folder as @/layer/….' },
            { regex: '^@/(app|main)$', message: 'Only src itself sees the whole.' },
            ...refused.map((other) => ({ regex: `^@/${other}(/|$)`, message: `${name} may not know ${other}.` })),
            ...extra,
          ],
        },
      ],
    },
  };
}

const kFeatures = readdirSync(new URL('src/features', import.meta.url));

export default tseslint.config(
  { ignores: ['dist/', 'node_modules/', 'src/api/generated/', 'test/screenshots/'] },
  ...tseslint.configs.strict,
  jsxA11y.flatConfigs.strict,
  reactHooks.configs.flat.recommended,
  {
    languageOptions: { globals: { ...globals.browser, ...globals.node } },
    rules: {
      'max-lines': ['error', { max: 400 }],
      '@typescript-eslint/no-non-null-assertion': 'error',
      '@typescript-eslint/consistent-type-imports': 'error',
    },
  },
  // The simulated trials index arrays whose length they made themselves.
  {
    files: ['test/**/*.ts'],
    rules: { '@typescript-eslint/no-non-null-assertion': 'off', 'max-lines': ['error', { max: 500 }] },
  },
  // A page of one component; a third of the lines is layout.
  { files: ['src/**/*.tsx'], rules: { 'max-lines': ['error', { max: 330 }] } },
  layer('language', ['language']),
  layer('units', ['units', 'language']),
  layer('api', ['api', 'units', 'language']),
  layer('ui', ['ui', 'units', 'language']),
  layer('charts', ['charts', 'units', 'language']),
  // A page of its own, which a station serves: it knows no server.
  layer('kiosk', ['kiosk', 'ui', 'units', 'language']),
  ...kFeatures.map((name) =>
    layer(
      `features/${name}`,
      ['language', 'units', 'api', 'ui', 'charts'],
      [{ regex: '^@/features/', message: 'Features never know each other.' }],
    ),
  ),
  {
    // Numbers become text in units/ alone, so that a unit is never forgotten and never written twice.
    files: ['src/{api,ui,charts,features,kiosk}/**/*.{ts,tsx}'],
    ignores: ['**/*.test.{ts,tsx}'],
    rules: {
      'no-restricted-syntax': [
        'error',
        {
          selector: 'CallExpression[callee.property.name=/^(toFixed|toPrecision|toLocaleString|toExponential)$/]',
          message: 'Format numbers in units/.',
        },
        { selector: "NewExpression[callee.object.name='Intl']", message: 'Format in units/.' },
      ],
    },
  },
);
