export * from './quantity';
export * from './format';
export * from './axis';
export * from './significant';
