import type { ReactNode } from 'react';
import { marked, say } from '@/language';
import { Button, DataTable, type DataColumn } from '@/ui';
import { formatCount, formatLength, kNone, type Metre } from '@/units';

/** What a DICOM series says of itself; null what it does not say. */
export interface Series {
  readonly uid: string;
  readonly number: number | null;
  readonly description: string;
  readonly modality: string;
  readonly files: number | null;
  readonly row_spacing_m: Metre | null;
  readonly column_spacing_m: Metre | null;
  readonly slice_spacing_m: Metre | null;
  readonly thickness_m: Metre | null;
}

interface Props<Row extends Series> {
  readonly series: readonly Row[] | undefined;
  readonly chosen: string | null;
  readonly onChoose: (series: Row) => void;
  /** A small picture of the series, where its pixels are at hand. */
  readonly picture?: (series: Row) => ReactNode;
}

const counted = (value: number | null) => (value === null ? kNone : formatCount(value));
const long = (value: Metre | null) => (value === null ? kNone : formatLength(value, 2));
const across = ({ row_spacing_m: down, column_spacing_m: along }: Series) =>
  down === along ? long(down) : `${long(down)} × ${long(along)}`;

/** The series of a study or of a folder, to choose one from. */
export function SeriesTable<Row extends Series>({ series, chosen, onChoose, picture }: Props<Row>) {
  const pictures: DataColumn<Row>[] = picture ? [{ name: marked('Middle slice'), cell: picture }] : [];
  return (
    <DataTable<Row>
      caption={say('Series of the study')}
      minWidth={720}
      rows={series}
      keyOf={({ uid }) => uid}
      empty={say('This study has no series.')}
      columns={[
        ...pictures,
        {
          name: marked('Series'),
          by: ({ number }) => number,
          cell: ({ number, description }) => `${counted(number)} ${description}`,
        },
        { name: marked('Modality'), by: ({ modality }) => modality, cell: ({ modality }) => modality },
        { name: marked('Files'), by: ({ files }) => files, cell: ({ files }) => counted(files), number: true },
        { name: marked('Pixel spacing'), by: ({ row_spacing_m }) => row_spacing_m, cell: across, number: true },
        {
          name: marked('Slice spacing'),
          by: ({ slice_spacing_m }) => slice_spacing_m,
          cell: ({ slice_spacing_m }) => long(slice_spacing_m),
          number: true,
        },
        {
          name: marked('Slice thickness'),
          by: ({ thickness_m }) => thickness_m,
          cell: ({ thickness_m }) => long(thickness_m),
          number: true,
        },
        {
          name: marked('Choose'),
          cell: (one) => (
            <Button aria-pressed={one.uid === chosen} onClick={() => onChoose(one)}>
              {say('Choose series {number}', {
                number: one.number === null ? one.description : formatCount(one.number),
              })}
            </Button>
          ),
        },
      ]}
    />
  );
}
