-- What every announced upload asks, found without a look at all rows that ever were: the size of what is being
-- received, and whether a study's slot was handed to the station. And the trials of a state, counted every ten minutes.
create index uploads_receiving on uploads (announced_utc_us) where state = 'receiving';
create index study_events_by_slot on study_events (slot_id);
create index trials_by_state on trials (state);
