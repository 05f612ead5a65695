import { marked, say } from '@/language';

const kWalls: Readonly<Record<string, string>> = {
  medial: marked('medial'),
  superior: marked('superior'),
  lateral: marked('lateral'),
  inferior: marked('inferior'),
  anterior: marked('anterior'),
};

/** A wall of the server's or a station's as a word of the page. */
export const wallName = (wall: string): string => say(kWalls[wall] ?? wall);
