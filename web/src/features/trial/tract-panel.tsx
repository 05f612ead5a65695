import { useQuery } from '@tanstack/react-query';
import { pathQuery, previewQuery, type Trial } from '@/api';
import { TractView, type Cursor } from '@/charts';
import { Button, Card, Notice, Skeleton, usePalette } from '@/ui';
import { formatLength, metre } from '@/units';

/** The tract in 3-D with the way of the tip. Without the bone where that cannot be had. */
export function TractPanel({ trial, cursor }: { readonly trial: Trial; readonly cursor: Cursor }) {
  const path = useQuery(pathQuery(trial.id));
  const preview = useQuery(previewQuery(trial.case_id));
  const palette = usePalette();
  const diameter = metre(2 * trial.tract.radius_m);
  const summary = `The tract, ${formatLength(trial.tract.length_m)} long and ${formatLength(diameter)} wide, with the bone round it and the way of the tip coloured by force.`;
  return (
    <Card title="Tract and way of the tip">
      {path.isError ? <Notice tone="bad" title="The way of the tip could not be loaded." onRetry={() => void path.refetch()}>{path.error.message}</Notice> : null}
      {preview.isError ? <Notice tone="warn" title="The bone could not be loaded; the rest is drawn without it." onRetry={() => void preview.refetch()}>{preview.error.message}</Notice> : null}
      {path.data && !preview.isPending ? (
        <TractView
          tract={trial.tract} path={path.data} bone={preview.data ?? null} cursor={cursor} palette={palette} summary={summary}
          button={(label, text, press, pressed) => <Button label={label} onClick={press} {...(pressed === undefined ? {} : { pressed })}>{text}</Button>}
        />
      ) : path.isError ? null : <Skeleton height="444px" />}
    </Card>
  );
}
