export * from './quantity';
export * from './format';
export * from './axis';
