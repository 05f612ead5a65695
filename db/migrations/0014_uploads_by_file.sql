-- How much of an upload is here, its file says: the length of what is flushed.
alter table uploads drop column offset_bytes;
alter table uploads drop column crc32c;
