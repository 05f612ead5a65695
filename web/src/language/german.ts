import type { Catalogue } from './language';

const kParts = import.meta.glob<Record<string, string>>('./messages/de/*.json', { eager: true, import: 'default' });

/** All parts of the catalogue in one: a part is a folder's sentences. */
export const catalogue: Catalogue = Object.assign({}, ...Object.values(kParts)) as Catalogue;
