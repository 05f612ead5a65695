import { useQuery } from '@tanstack/react-query';
import { pathQuery, previewQuery, type Tract, type Trial } from '@/api';
import { TractView, type Cursor } from '@/charts';
import { say } from '@/language';
import { Button, Card, Notice, Skeleton, usePalette } from '@/ui';
import { formatLength, metre } from '@/units';

interface Props {
  readonly trial: Trial;
  readonly tract: Tract;
  readonly cursor: Cursor;
}

/** The tract in 3-D with the way of the tip. Without the bone where that cannot be had. */
function Picture({ trial, tract, cursor }: Props) {
  const path = useQuery(pathQuery(trial.id));
  const preview = useQuery(previewQuery(trial.case_id));
  const palette = usePalette();
  const diameter = metre(2 * tract.radius_m);
  const summary = say(
    'The tract, {length} long and {width} wide, with the surrounding bone and the path of the tip, coloured by force.',
    { length: formatLength(tract.length_m), width: formatLength(diameter) },
  );
  return (
    <>
      {path.isError ? (
        <Notice tone="bad" title={say('The path of the tip could not be loaded.')} onRetry={() => void path.refetch()}>
          {path.error.message}
        </Notice>
      ) : null}
      {preview.isError ? (
        <Notice
          tone="warn"
          title={say('The bone could not be loaded. The view shows the tract without it.')}
          onRetry={() => void preview.refetch()}
        >
          {preview.error.message}
        </Notice>
      ) : null}
      {path.data && !preview.isPending ? (
        <TractView
          tract={tract}
          path={path.data}
          bone={preview.data ?? null}
          cursor={cursor}
          palette={palette}
          summary={summary}
          button={(label, text, press, pressed) => (
            <Button label={label} onClick={press} {...(pressed === undefined ? {} : { pressed })}>
              {text}
            </Button>
          )}
        />
      ) : path.isError ? null : (
        <Skeleton height="444px" />
      )}
    </>
  );
}

export function TractPanel({ trial, cursor }: { readonly trial: Trial; readonly cursor: Cursor }) {
  return (
    <Card title={say('Tract and path of the tip')}>
      {trial.tract ? (
        <Picture trial={trial} tract={trial.tract} cursor={cursor} />
      ) : (
        <p>{say('The case of this trial is not on this server.')}</p>
      )}
    </Card>
  );
}
