export { ApiError, type ApiErrorCode } from './client';
export type { Preview } from './preview';
export * from './queries';
export type * from './schemas';
