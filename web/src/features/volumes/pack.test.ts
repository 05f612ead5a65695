// @vitest-environment node
import { unzipSync } from 'fflate';
import { expect, it } from 'vitest';
import { nameFrom, pack } from './pack';

const file = (path: string, text = 'x') => ({ path, file: new File([text], path.split('/').at(-1) ?? '') });

it('sends a volume file as it is', async () => {
  const nifti = file('L3.nii.gz');
  expect(await pack([nifti])).toBe(nifti.file);
});

it('zips a folder of slices without their names, which may name a patient', async () => {
  const folder = ['Doe^Jane/IM001', 'Doe^Jane/IM002', 'Doe^Jane/.DS_Store'].map((path) => file(path, path));
  const zipped = await pack(folder);
  const inside = unzipSync(new Uint8Array(await zipped.arrayBuffer()));
  expect(Object.keys(inside)).toEqual(['1.dcm', '2.dcm']);
  expect(new TextDecoder().decode(inside['2.dcm'])).toBe('Doe^Jane/IM002');
});

it('refuses nothing at all', async () => {
  await expect(pack([])).rejects.toThrow('No files');
});

it('takes a name from a volume file, never from a folder or an archive, which may name a patient', () => {
  expect(nameFrom([file('./L3.nrrd')])).toBe('L3');
  expect(nameFrom([file('Doe^Jane/a'), file('Doe^Jane/b')])).toBe('');
  expect(nameFrom([file('Doe^Jane/a')])).toBe('');
  expect(nameFrom([file('Doe_Jane.zip')])).toBe('');
});
