import { useRef, type ReactNode } from 'react';
import { useDropzone } from 'react-dropzone';
import { say } from '@/language';
import { Button } from './button';
import styles from './drop-zone.module.css';

export interface Dropped {
  readonly path: string;
  readonly file: File;
}

interface Props {
  /** What is brought: "New measurements". */
  readonly label: string;
  /** What a folder holds, and what may be chosen without one; for a screen reader. */
  readonly folder: string;
  readonly files: string;
  /** Label of the button that chooses files. */
  readonly choose: string;
  readonly onFiles: (files: readonly Dropped[]) => void;
  readonly busy: string | null;
  readonly children: ReactNode;
}

const pathOf = (file: File & { readonly path?: string; readonly relativePath?: string }) =>
  file.relativePath ?? file.path ?? (file.webkitRelativePath || file.name);
const dropped = (files: readonly File[]): Dropped[] => files.map((file) => ({ path: pathOf(file), file }));

/** A place for a folder or a file: dragged here, or chosen by one of two buttons. */
export function DropZone({ label, folder, files: named, choose, onFiles, busy, children }: Props) {
  const folderInput = useRef<HTMLInputElement>(null);
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
      {...getRootProps({ className: styles.zone, role: 'group', 'aria-label': label })}
      data-over={isDragActive || undefined}
      data-part="drop"
    >
      <input {...getInputProps({ 'aria-label': named, tabIndex: -1 })} />
      <input
        ref={folderInput}
        type="file"
        hidden
        webkitdirectory=""
        aria-label={folder}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = '';
          if (files.length > 0) onFiles(dropped(files));
        }}
      />
      <p className={styles.text}>{busy ?? (isDragActive ? say('Release to add the files.') : children)}</p>
      <div className={styles.buttons}>
        <Button onClick={() => folderInput.current?.click()} disabled={busy !== null}>
          {say('Choose folder')}
        </Button>
        <Button onClick={open} disabled={busy !== null}>
          {choose}
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
