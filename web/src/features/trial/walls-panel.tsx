import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import { pathQuery, type Trial } from '@/api';
import { kSides, lowerBound, WallMap, type Cursor, type Side } from '@/charts';
import { say } from '@/language';
import { Card } from '@/ui';

function sideBreached(trial: Trial): Side | undefined {
  const wall = trial.truth?.breached;
  return kSides.find((side) => side === wall);
}

export function WallsPanel({ trial, cursor }: { readonly trial: Trial; readonly cursor: Cursor }) {
  const path = useQuery(pathQuery(trial.id)).data;
  const { tract, coverage } = trial;
  const depthAt = useMemo(
    () => (t_s: number) => {
      const tip = path?.tip_m[Math.min(lowerBound(path.t_s, t_s), path.t_s.length - 1)];
      if (!tip || !tract) return null;
      return tract.axis.reduce((depth, along, i) => depth + along * ((tip[i] ?? 0) - (tract.entry_m[i] ?? 0)), 0);
    },
    [path, tract],
  );
  const bins = useMemo(
    () => coverage && { depthBins: coverage.depth_bins, angleBins: coverage.angle_bins, samples: coverage.samples },
    [coverage],
  );
  return (
    <Card title={say('Walls touched')}>
      {tract && bins && bins.depthBins > 0 && bins.angleBins > 0 ? (
        <WallMap
          bins={bins}
          length_m={tract.length_m}
          breached={sideBreached(trial)}
          depthAt={depthAt}
          cursor={cursor}
        />
      ) : (
        <p>{trial.state === 'assessing' ? say('Being assessed.') : say('Not available for this trial.')}</p>
      )}
      {trial.truth?.breached === 'anterior' ? (
        <p>{say('The breach is at the anterior end, beyond the side walls.')}</p>
      ) : null}
    </Card>
  );
}
