import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import { forceDepthQuery, type Trial } from '@/api';
import { DepthChart, kDepthHeight_px, type Bone, type Cursor } from '@/charts';
import { say } from '@/language';
import { Card, Notice, Skeleton } from '@/ui';

/** The bone behind the curve, where it may be known. */
function boneOf(trial: Trial): Bone | null {
  const { scenario } = trial;
  if (!scenario) return null;
  return {
    travel_m: scenario.travel_m,
    layers: scenario.layers.map((layer) => ({
      from_m: layer.start_m,
      to_m: layer.start_m + layer.thickness_m,
      stiffness_N_per_m: layer.stiffness_N_per_m,
    })),
    walls: scenario.walls.map((wall) => ({
      at_m: wall.position_m,
      growsFrom_m: wall.position_m - wall.resistance_interval_m,
      breachTo_m: wall.position_m + wall.breach_interval_m,
    })),
  };
}

/** Force against depth with the layers and walls behind it. */
export function DepthPanel({ trial, cursor }: { readonly trial: Trial; readonly cursor: Cursor }) {
  const curve = useQuery(forceDepthQuery(trial.id));
  const bone = useMemo(() => boneOf(trial), [trial]);
  const felt_m = trial.answer?.breach ? trial.answer.depth_m : null;
  return (
    <Card title={say('Force against depth')}>
      {curve.isError ? (
        <Notice tone="bad" title={say('The curve could not be loaded.')} onRetry={() => void curve.refetch()}>
          {curve.error.message}
        </Notice>
      ) : null}
      {curve.data ? (
        <DepthChart
          t_s={curve.data.t_s}
          depth_m={curve.data.depth_m}
          force_N={curve.data.force_N}
          bone={bone}
          felt_m={felt_m}
          cursor={cursor}
        />
      ) : curve.isPending ? (
        <Skeleton height={`${kDepthHeight_px}px`} />
      ) : null}
    </Card>
  );
}
