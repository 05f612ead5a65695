import { useQuery } from '@tanstack/react-query';
import { useEffect, useRef } from 'react';
import { say } from '@/language';
import { Notice } from '@/ui';
import { middleSlice, type DicomSeries } from './dicom-series';
import { SeriesTable } from './series-table';
import styles from './volumes.module.css';

function MiddleSlice({ series }: { readonly series: DicomSeries }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { data: picture } = useQuery({
    queryKey: ['middle slice', series.uid, series.slices.length],
    queryFn: () => middleSlice(series).catch(() => null),
    staleTime: Infinity,
    gcTime: 0,
  });
  useEffect(() => {
    const context = canvas.current?.getContext('2d');
    if (!picture || !context) return;
    const image = context.createImageData(picture.width, picture.height);
    for (const [i, grey] of picture.grey.entries()) image.data.set([grey, grey, grey, 255], 4 * i);
    context.putImageData(image, 0, 0);
  }, [picture]);
  if (picture === null) return <span className={styles.muted}>{say('compressed: shown after the upload')}</span>;
  if (picture === undefined) return <span className={styles.thumbnail} />;
  return (
    <canvas
      ref={canvas}
      className={styles.thumbnail}
      width={picture.width}
      height={picture.height}
      aria-hidden="true"
    />
  );
}

interface Props {
  readonly series: readonly DicomSeries[];
  readonly chosen: string | null;
  readonly onChoose: (series: DicomSeries) => void;
}

/** A volume is one series: where a folder or a zip holds several, a person chooses. */
export function SeriesChoice({ series, chosen, onChoose }: Props) {
  return (
    <div className={styles.stack}>
      <Notice tone="info" title={say('{count} series were found. Choose one.', { count: series.length })}>
        {say(
          'Only the files of the chosen series are uploaded. For palpation choose thin slices and a kernel for bone.',
        )}
      </Notice>
      <SeriesTable
        series={series}
        chosen={chosen}
        onChoose={onChoose}
        picture={(one) => <MiddleSlice series={one} />}
      />
    </div>
  );
}
