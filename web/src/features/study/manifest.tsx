/** The page of one study. */
import type { Feature } from '@/ui';
import { StudyPage } from './study-page';

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/studies/:id', show: (at) => <StudyPage key={at('id')} id={at('id')} /> }],
};
