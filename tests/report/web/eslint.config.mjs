// The page's script: ESLint's recommended rules, and none of the ways by which text becomes markup or code.
import js from '@eslint/js';
import noUnsanitized from 'eslint-plugin-no-unsanitized';

const globals = Object.fromEntries(
  ['document', 'window', 'performance', 'atob', 'Option', 'location', 'addEventListener'].map(name => [name, 'readonly']));

export default [
  js.configs.recommended,
  noUnsanitized.configs.recommended,
  {
    languageOptions: {ecmaVersion: 2020, sourceType: 'script', globals},
    rules: {
      'no-eval': 'error',
      'no-implied-eval': 'error',
      'no-new-func': 'error',
      'no-restricted-properties': ['error', {property: 'innerHTML'}, {property: 'outerHTML'}, {property: 'insertAdjacentHTML'}],
    },
  },
];
