/** The list of a class as it comes out of a spreadsheet, made into the one form that the server reads. Pure. */
import Papa from 'papaparse';

/** What people call the columns, in lower case, by the server's name. */
const kColumns: Readonly<Record<string, readonly string[]>> = {
  name: ['name', 'full name', 'resident', 'trainee', 'person'],
  role: ['role'],
  level: ['level', 'pgy', 'year', 'training level'],
  badge: ['badge', 'badge number', 'card', 'card number'],
  pin: ['pin'],
};

function columnOf(text: string): string {
  const typed = text.trim().toLowerCase();
  return Object.entries(kColumns).find(([, names]) => names.includes(typed))?.[0] ?? text.trim();
}

/** With commas, whatever separated the cells, and with the server's names of columns; a line stays a line. */
export function plainList(text: string): string {
  const { data } = Papa.parse<string[]>(text.replace(/^\uFEFF/, ''), { skipEmptyLines: false });
  const [header = [], ...rows] = data;
  const trimmed = rows.map((row) => row.map((cell) => cell.trim()));
  return Papa.unparse([header.map(columnOf), ...trimmed], { newline: '\n' });
}

export const kExample = 'name,level,badge,pin\n"Berg, Ida",PGY-1,10021,4711\nUlf Nord,PGY-2,10022,\n';
