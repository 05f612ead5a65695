export { ApiError, type ApiErrorCode } from './client';
export type { Preview } from './preview';
export * from './queries';
export type * from './schemas';
export * from './study-queries';
export type * from './study-schemas';
export * from './lab-queries';
export type * from './lab-schemas';
