import { useRef, type ReactNode } from 'react';
import { useDropzone } from 'react-dropzone';
import { Button } from '@/ui';
import styles from './drop-zone.module.css';
import type { Dropped } from './zip-files';

interface Props {
  readonly onFiles: (files: readonly Dropped[]) => void;
  readonly busy: string | null;
  readonly children: ReactNode;
}

const pathOf = (file: File & { readonly path?: string; readonly relativePath?: string }) =>
  file.relativePath ?? file.path ?? (file.webkitRelativePath || file.name);
const dropped = (files: readonly File[]): Dropped[] => files.map((file) => ({ path: pathOf(file), file }));

/** A place for a folder or a zip: dragged here, or chosen by one of two buttons. */
export function DropZone({ onFiles, busy, children }: Props) {
  const folder = useRef<HTMLInputElement>(null);
  const { getRootProps, getInputProps, isDragActive, open } = useDropzone({
    onDrop: (files) => {
      if (files.length > 0) onFiles(dropped(files));
    },
    noClick: true,
    noKeyboard: true,
    disabled: busy !== null,
  });
  return (
    <div
      {...getRootProps({ className: styles.zone, role: 'group', 'aria-label': 'New measurements' })}
      data-over={isDragActive || undefined}
      data-part="drop"
    >
      <input {...getInputProps({ 'aria-label': 'A zip file, or set.json with its CSV files', tabIndex: -1 })} />
      <input
        ref={folder}
        type="file"
        hidden
        webkitdirectory=""
        aria-label="A folder with set.json"
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = '';
          if (files.length > 0) onFiles(dropped(files));
        }}
      />
      <p className={styles.text}>{busy ?? (isDragActive ? 'Release to add the files.' : children)}</p>
      <div className={styles.buttons}>
        <Button onClick={() => folder.current?.click()} disabled={busy !== null}>
          Choose folder
        </Button>
        <Button onClick={open} disabled={busy !== null}>
          Choose zip file
        </Button>
      </div>
    </div>
  );
}

declare module 'react' {
  interface InputHTMLAttributes<T> {
    webkitdirectory?: T extends HTMLInputElement ? string : never;
  }
}
