/** How large a study the server and its statistics take, beside other programs on the same machine. */
import { marked, say } from '@/language';
import { Card, Table } from '@/ui';

interface Figure {
  readonly task: string;
  readonly ours: string;
  readonly other: string;
}

// bench_export --gib 20, bench_statistics --only mixed and answers (lme4 1.1-31).
const kFigures: readonly Figure[] = [
  {
    task: marked('Export of simulated trials, zipped while it is sent'),
    ours: '191 MB/s, 21 MB',
    other: 'cp: 2218 MB/s',
  },
  { task: marked('Export of 20 GiB'), ours: '838 MB/s, 20 MB', other: '–' },
  {
    task: marked('Linear mixed model, 1,000,000 trials, 10,000 surgeons, 1,000 scenarios'),
    ours: '70 s, 290 MB',
    other: 'lme4: 47 s',
  },
  { task: marked('Logistic mixed model, 100,000 answers'), ours: '5 s, 40 MB', other: 'lme4: 22 s' },
  {
    task: marked('Logistic mixed model, 1,000,000 answers, 10,000 surgeons, 1,000 scenarios'),
    ours: '80 s, 382 MB',
    other: 'lme4, nAGQ = 0: 103 s',
  },
];

export function Figures() {
  return (
    <Card title={say('How large a study can be')}>
      <p>
        {say(
          'Measured on a machine with two processor cores: time or speed, and memory. Estimates of the linear model agree with lme4 within 1e-8, those of the logistic model within 1e-4.',
        )}
      </p>
      <Table
        caption={say('Time, speed and memory')}
        columns={[
          { name: say('Task'), cell: (row: Figure) => say(row.task) },
          { name: 'Tractus', cell: (row: Figure) => row.ours },
          { name: say('Other program'), cell: (row: Figure) => row.other },
        ]}
        rows={kFigures}
        keyOf={(row) => row.task}
        empty=""
      />
    </Card>
  );
}
