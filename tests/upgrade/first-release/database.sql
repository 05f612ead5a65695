BEGIN TRANSACTION;
CREATE TABLE accounts (
  id text primary key,
  name text not null unique,
  role text not null,
  password_hash text not null,
  made_utc_us bigint not null
, state text not null default 'active', pseudonym text, badge text, pin_hash text, totp_secret text, totp_confirmed bigint not null default 0, totp_step bigint not null default 0, must_change bigint not null default 0, level text not null default '');
INSERT INTO "accounts" VALUES('01a21b86d36332f4f324ce8ab79d9fe9','admin','admin','$argon2id$v=19$m=65536,t=2,p=1$gTzJwpXZisU7jOLczj0sQg$ViyE0ntSc+cFJrvIxawpE5KkZ2Zq48fEwwwYbjn8BzY',1795758150499921,'active',NULL,NULL,NULL,NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b86df21810c9438848f2126c10f','dora','director','$argon2id$v=19$m=65536,t=2,p=1$fQH3GWyFyUYQNtISVyBQVA$7wL+AlOUxx4CALGPZncbH15KmZCsoiGaCe99jj0rr9E',1795758154392532,'active','Pkq2xqbbn',NULL,NULL,NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b86ef0d270c0713f2e70b977c1b','fay','faculty','$argon2id$v=19$m=65536,t=2,p=1$66VGWCpYqLPLjxVRD8I4VQ$gNDBws185M1JVqpeZ96EVb2F2z6VrkiE/Sa2CwpG4XU',1795758158456065,'active','P8sjdp20f',NULL,NULL,NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b86fc0232e2db6529ea19525186','rob','researcher','$argon2id$v=19$m=65536,t=2,p=1$JfzX4ndXgw0TywUZ/oPHgQ$Z288c/lyrRtJ6pDYSqPPyoAGVwfegHUkoqcmfE7Y+jw',1795758161435344,'active','Pw9e9d7c1',NULL,NULL,NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b870785cec8c961993482eec74f','tech','technician','$argon2id$v=19$m=65536,t=2,p=1$MBg2b09tJWckj3KfpXyZVA$ezz+xUfSGRzVVbiJk0X+5FPrLsq76uTfyH6TIKgPIT8',1795758164457038,'active','Pkrdaqjdf',NULL,NULL,NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b87159550c045e5bdb289cfff5b','tom','trainee','$argon2id$v=19$m=65536,t=2,p=1$mQDXhnyZrxIz3oE09U04Ww$vFadzsLmIp8lPGI47SMxqfjVPO3cEtyV/adw+cjioSY',1795758168782431,'active','Pexqtskrn','B-1','$argon2id$v=19$m=65536,t=2,p=1$ZuUHqJqxfxwWwA8MfCmnPg$wsJJ8+XSmYbZ/9Z+A3NRwBrEiU95X/jokhN+m0X+YRM',NULL,0,0,0,'');
INSERT INTO "accounts" VALUES('01a21b8725d6979005e224bcba929ed5','zoe','trainee','$argon2id$v=19$m=65536,t=2,p=1$cO5VyJ2eqhzHcyZ9fqiegA$bRvIP0qK21FFhMTvQFMeXtlcbmme4apMHwLqiOgGAyM',1795758172203541,'active','Pf0qn30ka',NULL,NULL,NULL,0,0,0,'');
CREATE TABLE analyses (
  id text primary key,
  plan_id text references analysis_plans (id),
  study text not null,
  plan text not null references objects (sha256),
  state text not null,
  share double precision not null,
  snapshot text references objects (sha256),
  description text references objects (sha256),
  result text references objects (sha256),
  report text references objects (sha256),
  data text references objects (sha256),
  error text not null,
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
CREATE TABLE analysis_plans (
  id text primary key,
  title text not null,
  study text not null,
  plan text not null references objects (sha256),
  data_seen bigint not null,
  trials_then bigint not null,
  made_utc_us bigint not null,
  made_by text not null
);
INSERT INTO "analysis_plans" VALUES('01a21b8737ff924c9528846b153d4612','A plan','','df675fa021d649a2696eb52a262e3419edcabfb46b8a8b328c031f43795ea404',1,2,1795758176255073,'rob');
CREATE TABLE api_token_uses (
  token_id text primary key references api_tokens (id),
  used_utc_us bigint not null
);
CREATE TABLE api_tokens (
  id text primary key,
  account_id text not null references accounts (id),
  name text not null,
  token_hash text not null unique,
  scopes text not null,
  made_utc_us bigint not null,
  expires_utc_us bigint not null,
  revoked_utc_us bigint,
  revoked_by text not null default ''
);
INSERT INTO "api_tokens" VALUES('01a21b8738c57d193778145b099d329a','01a21b86fc0232e2db6529ea19525186','notebook','52f70e219db02fed951e0058ee058a225d900375971557c53fe151f4a430f207','studies:read lab:read',1795758176453329,1821678176452556,NULL,'');
CREATE TABLE assigned_progress (
  account_id text not null,
  study_id text not null,
  participant text not null,
  finished bigint not null,
  primary key (account_id, study_id),
  foreign key (study_id, account_id) references assignment_people (study_id, account_id)
);
INSERT INTO "assigned_progress" VALUES('01a21b87159550c045e5bdb289cfff5b','a-01a21b8732035ad97af1aec3','Pexqtskrn',0);
INSERT INTO "assigned_progress" VALUES('01a21b8725d6979005e224bcba929ed5','a-01a21b8732035ad97af1aec3','Pf0qn30ka',0);
CREATE TABLE assignment_entries (
  study_id text primary key references assignments (study_id),
  finished bigint not null,
  due_utc_us bigint not null,
  made_utc_us bigint not null,
  title text not null,
  cohort_name text not null,
  release text not null,
  made_by_id text not null,
  cohort_id text,
  words text not null
);
INSERT INTO "assignment_entries" VALUES('a-01a21b8732035ad97af1aec3',0,9000000000000000,1795758174746725,'week 1','year 1','at_once','01a21b86ef0d270c0713f2e70b977c1b','01a21b8731c5be7f2dbd69b320b6b96e','week 1 year 1 fay');
CREATE TABLE assignment_names (
  study_id text not null references assignments (study_id),
  case_id text not null references cases (id),
  name text not null,
  primary key (study_id, case_id)
);
CREATE TABLE assignment_people (
  study_id text not null references assignments (study_id),
  account_id text not null references accounts (id),
  participant text not null,
  primary key (study_id, account_id),
  unique (study_id, participant)
);
INSERT INTO "assignment_people" VALUES('a-01a21b8732035ad97af1aec3','01a21b87159550c045e5bdb289cfff5b','Pexqtskrn');
INSERT INTO "assignment_people" VALUES('a-01a21b8732035ad97af1aec3','01a21b8725d6979005e224bcba929ed5','Pf0qn30ka');
CREATE TABLE assignments (
  study_id text primary key references studies (id),
  cohort_id text references cohorts (id),
  due_utc_us bigint,
  release text not null,
  made_by_id text not null references accounts (id)
);
INSERT INTO "assignments" VALUES('a-01a21b8732035ad97af1aec3','01a21b8731c5be7f2dbd69b320b6b96e',NULL,'at_once','01a21b86ef0d270c0713f2e70b977c1b');
CREATE TABLE audit (
  number bigint primary key,
  at_utc_us bigint not null,
  who text not null,
  role text not null,
  peer text not null,
  what text not null,
  object text not null,
  detail text not null,
  hash text not null
, changes text not null default '');
INSERT INTO "audit" VALUES(1,1795758149754661,'server','server','','beginCoverage','','{"tables":{"accounts":{"keys":["id"],"columns":["name","role","password_hash","made_utc_us","state","pseudonym","badge","pin_hash","totp_secret","totp_confirmed","must_change","level"]},"oidc_subjects":{"keys":["issuer","subject"],"columns":["account_id","linked_utc_us","linked_by"]},"api_tokens":{"keys":["id"],"columns":["account_id","name","token_hash","scopes","made_utc_us","expires_utc_us","revoked_utc_us","revoked_by"]},"group_rules":{"keys":["version"],"columns":["definition","reason","made_utc_us","made_by"]},"group_accounts":{"keys":["account_id"],"columns":["version","seen_utc_us","left_utc_us"]},"stations":{"keys":["id"],"columns":["name","token_hash","enrolled_utc_us","revoked_utc_us"]},"notification_addresses":{"keys":["account_id"],"columns":["address"]},"webhooks":{"keys":["id"],"columns":["url","kinds","secret","made_utc_us","made_by"]},"cohorts":{"keys":["id"],"columns":["name","made_utc_us","made_by"]},"cohort_people":{"keys":["cohort_id","account_id"],"columns":["part","since_utc_us"]},"cohort_invitations":{"keys":["cohort_id","account_name"],"columns":["made_utc_us","made_by"]},"consents":{"keys":["account_id","study_id","participant"],"columns":["tier","basis","noted_utc_us","noted_by"]},"pseudonym_keys":{"keys":["fingerprint"],"columns":["since_utc_us"]},"cases":{"keys":["id"],"columns":["title","source","made_utc_us","published_utc_us","kind","retired_utc_us","planned","felt"]},"case_parts":{"keys":["case_id","name"],"columns":["sha256","size_bytes","secret"]},"studies":{"keys":["id"],"columns":["title","state","ordering","repeats","seed","on_invalid","made_utc_us","made_by","kind"]},"study_scenarios":{"keys":["study_id","position"],"columns":["case_id"]},"study_participants":{"keys":["study_id","name"],"columns":["position","state","level","experience_years","simulated","enrolled_utc_us"]},"study_slots":{"keys":["id"],"columns":["study_id","participant","position","attempt","case_id","state","station_id","repeat_of","changed_utc_us"]},"study_trials":{"keys":["trial_id"],"columns":["slot_id","state","reason","changed_utc_us","tool"]},"study_events":{"keys":["study_id","number"],"columns":["at_utc_us","who","what","participant","slot_id","trial_id","reason"]},"assignments":{"keys":["study_id"],"columns":["cohort_id","due_utc_us","release","made_by_id"]},"assignment_people":{"keys":["study_id","account_id"],"columns":["participant"]},"trials":{"keys":["id"],"columns":["case_id","station_id","sha256","operator_name","simulated","started_utc_us","received_utc_us","duration_s","samples","complete","late_ticks","not_converged","skipped_ticks","header","events","state","failure","correct","coverage"]},"trial_metrics":{"keys":["trial_id"],"columns":["metric_id","position","value","note"]},"rubrics":{"keys":["id","version"],"columns":["title","definition","reason","made_utc_us","made_by"]},"rating_requests":{"keys":["trial_id","rubric_id"],"columns":["version","blind","raters","made_utc_us","made_by"]},"ratings":{"keys":["trial_id","rubric_id","rater_id","number"],"columns":["scores","comment","reason","independent","made_utc_us"]},"criteria":{"keys":["kind","subject","version"],"columns":["definition","reason","made_utc_us","made_by"]},"curricula":{"keys":["id","version"],"columns":["title","definition","reason","made_utc_us","made_by"]},"curriculum_steps":{"keys":["study_id"],"columns":["curriculum_id","version","step_id"]},"erasures":{"keys":["number"],"columns":["account_id","mode","cause","state","begun_utc_us","done_utc_us"]},"redactions":{"keys":["number"],"columns":["digest"]},"retention_rules":{"keys":["version"],"columns":["definition","reason","made_utc_us","made_by"]},"analysis_plans":{"keys":["id"],"columns":["title","study","plan","data_seen","trials_then","made_utc_us","made_by"]}},"differences":0}','2e74439987b2b0bb1af78c6a5e734f44062d087b37c58a2d602ca09bd68166ba','[]');
INSERT INTO "audit" VALUES(2,1795758150499848,'command line: root','command line','','init','','{"name":"admin"}','63d8354cab978f8ddf673ca5d99f389b7661d463c933eecc9fed74e06c4314aa','[["accounts","[\"01a21b86d36332f4f324ce8ab79d9fe9\"]","3c18be826c134316cbe420ff307016e3"]]');
INSERT INTO "audit" VALUES(3,1795758151175168,'command line: root','command line','','publish','','{"case":"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575"}','fdecab037b2957c0901ca78ff4184a2b32569f8a126d40493aa51eaa446c5331','[["cases","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\"]","1a8e9b55aa95f57085a40b3ca0e3f9bf"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"case.json\"]","c2e5b8715a41a8b1bfb191c7cda6acb1"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"case.sig\"]","e91eed28a6a09ca5f35cbcf641878abb"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"certificate.json\"]","0d1a52d50307c6c3ad2e659f3f5694a9"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"picture.png\"]","6a6d4e9694b868434ac460b9b3afab73"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"truth.json\"]","71d923c103ed9db736ef85d0cb193abf"],["case_parts","[\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",\"volume.tvol\"]","eb6f6175ac4003ac23d6cb74467b959c"]]');
INSERT INTO "audit" VALUES(4,1795758151917660,'server','server','','serverWork','','{}','31eb6cc4a1cfb948f6a307fb97608aab4c1ccaec0cc67b2c8ee42832659c0348','[["pseudonym_keys","[\"6019cc564e9b494d6bba1c801da721e1\"]","9106381798b1eccc9c80a833a369d036"]]');
INSERT INTO "audit" VALUES(5,1795758152273250,'admin','admin','127.0.0.1','signIn','','{"name":"admin","password":"(not kept)"}','7fad8d9df98ea9e457e342b575ad15e400c521f64e068946ae5936507a345cb8','');
INSERT INTO "audit" VALUES(6,1795758153505364,'admin','admin','127.0.0.1','addAccount','','{"name":"dora","role":"director"}','cf943bb1e8189b9296c135e6ce227af01e2990bf21205d1934404d118151dd1a','[["accounts","[\"01a21b86df21810c9438848f2126c10f\"]","187836a333b54fd69cde37c8e58204b1"]]');
INSERT INTO "audit" VALUES(7,1795758154569408,'dora','director','127.0.0.1','signIn','','{"name":"dora","password":"(not kept)"}','65fd837c2f4b5e02170851693632ef73311dcddfed6d0d48b84ef0d0ed990687','');
INSERT INTO "audit" VALUES(8,1795758155336178,'dora','director','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','e333615d94d1a41424f60293bbd57f84bd164b7752e4edc5326074f4de42b29a','[["accounts","[\"01a21b86df21810c9438848f2126c10f\"]","06c30d4f3ebb9518595251c951f9fba7"]]');
INSERT INTO "audit" VALUES(9,1795758156874085,'dora','director','127.0.0.1','signIn','','{"name":"dora","password":"(not kept)"}','f1e9f2bcde5581e01333c51b50bbbb66fefa68eabcb802b84951f7f80feb75b2','');
INSERT INTO "audit" VALUES(10,1795758157581341,'admin','admin','127.0.0.1','addAccount','','{"name":"fay","role":"faculty"}','fcaa0073309cbcecf4e6dd188ad11f5bf19b41b3723b05039644cede14f84d09','[["accounts","[\"01a21b86ef0d270c0713f2e70b977c1b\"]","37f5e03feb3a9677262a232efffe1779"]]');
INSERT INTO "audit" VALUES(11,1795758158793511,'fay','faculty','127.0.0.1','signIn','','{"name":"fay","password":"(not kept)"}','ec29c531055777bb5364c81aff5c51d1053d0af8a462bb0af50e0d46e4ddc62f','');
INSERT INTO "audit" VALUES(12,1795758159365757,'fay','faculty','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','868ae86f7301eadc6059e4944aeda63f12e7c324ab11bfeea138a86f96d5a9b2','[["accounts","[\"01a21b86ef0d270c0713f2e70b977c1b\"]","eba67a0a18cee1eb88bfc4673f14929a"]]');
INSERT INTO "audit" VALUES(13,1795758160376796,'fay','faculty','127.0.0.1','signIn','','{"name":"fay","password":"(not kept)"}','63ec4b377b7902284210d9b0694fec1924f54f6f63b8d83167ba4fda16d2dbe2','');
INSERT INTO "audit" VALUES(14,1795758160898443,'admin','admin','127.0.0.1','addAccount','','{"name":"rob","role":"researcher"}','ecd7bd9e8a44d6d73a9b91851839480ae59895b734946fc3f1a210d978e4e483','[["accounts","[\"01a21b86fc0232e2db6529ea19525186\"]","71af723ecd44595e08de43f03ffb87f0"]]');
INSERT INTO "audit" VALUES(15,1795758161578208,'rob','researcher','127.0.0.1','signIn','','{"name":"rob","password":"(not kept)"}','9940f024af76cde773d058fe0d6218122074e137b39a0ed44ffeeb6f2ec1f299','');
INSERT INTO "audit" VALUES(16,1795758162093356,'rob','researcher','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','4baa6114d45747363d686a1c962118144c5021d33f16ded82e02a4e8976347a4','[["accounts","[\"01a21b86fc0232e2db6529ea19525186\"]","cce81876156e9899cc3e5013e1d4fc3b"]]');
INSERT INTO "audit" VALUES(17,1795758163286299,'rob','researcher','127.0.0.1','signIn','','{"name":"rob","password":"(not kept)"}','13d73b3a47b8084c4e88c9fdbfd10c37d432a6e9be7e8055750651c4244dc659','');
INSERT INTO "audit" VALUES(18,1795758163845419,'admin','admin','127.0.0.1','addAccount','','{"name":"tech","role":"technician"}','59b0f08eedb9b04e041b0b9f3855aef6963085968676d17d6aef945a2429a6ae','[["accounts","[\"01a21b870785cec8c961993482eec74f\"]","544a88fd506e9076f4cffb552e338462"]]');
INSERT INTO "audit" VALUES(19,1795758164472963,'tech','technician','127.0.0.1','signIn','','{"name":"tech","password":"(not kept)"}','1526edbddceafafc442f12944679cd0dfce7f3d9776703ecaf6e4ed997cdee2d','');
INSERT INTO "audit" VALUES(20,1795758165261200,'tech','technician','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','70a919c6ae10050bf39a77228810289c64afe8db4df924e65188f314dabf9280','[["accounts","[\"01a21b870785cec8c961993482eec74f\"]","6c066c68a0317e0bc4489a0cfbb28bfa"]]');
INSERT INTO "audit" VALUES(21,1795758166712281,'tech','technician','127.0.0.1','signIn','','{"name":"tech","password":"(not kept)"}','121106e97413d0d8a17f1516564b9fed5bd857cbf70cbb7228b37ebf300e246e','');
INSERT INTO "audit" VALUES(22,1795758167445411,'admin','admin','127.0.0.1','addAccount','','{"name":"tom","role":"trainee","badge":"B-1","pin":"(not kept)"}','df6b33344d34e09ed42f9e05fdca11e521d1c5c7575964ed62c5da18fa7c15dd','[["accounts","[\"01a21b87159550c045e5bdb289cfff5b\"]","11acce769d724a9abe0cbb632f48bcb1"]]');
INSERT INTO "audit" VALUES(23,1795758168849415,'tom','trainee','127.0.0.1','signIn','','{"name":"tom","password":"(not kept)"}','41aebc1a13b9e2075a5b296ef427004e0b6e7d08d578bc4b05bae7c374f0325d','');
INSERT INTO "audit" VALUES(24,1795758169513696,'tom','trainee','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','57dc85ad59489e68cc0d4e0891528ad7ab594835273a32f1cae139a0008891db','[["accounts","[\"01a21b87159550c045e5bdb289cfff5b\"]","d03f0fd86471435db0d39fee429220b2"]]');
INSERT INTO "audit" VALUES(25,1795758170682606,'tom','trainee','127.0.0.1','signIn','','{"name":"tom","password":"(not kept)"}','a112fd8f4cb2a18ea9ac1aa8dd567b2fa2188198ed6623afeec0450217233b5b','');
INSERT INTO "audit" VALUES(26,1795758171606168,'admin','admin','127.0.0.1','addAccount','','{"name":"zoe","role":"trainee"}','cb23cba6224b1ef3510bef439b07047980952f847c5a13726f6698fa936ac2c8','[["accounts","[\"01a21b8725d6979005e224bcba929ed5\"]","5d6219e56e7063856dac1fba5ab2be8f"]]');
INSERT INTO "audit" VALUES(27,1795758172230354,'zoe','trainee','127.0.0.1','signIn','','{"name":"zoe","password":"(not kept)"}','6dda8885489c4e3522250567e994c5312fb85df77feab5be98bfb6a7f1364372','');
INSERT INTO "audit" VALUES(28,1795758172850382,'zoe','trainee','127.0.0.1','changePassword','','{"old":"(not kept)","new":"(not kept)"}','eec932e6ce83e28184a84c1163ffb226e36c2b6ad310421acb06498f69e59f95','[["accounts","[\"01a21b8725d6979005e224bcba929ed5\"]","36d26118bbb8d3ffa5206c0c817764c1"]]');
INSERT INTO "audit" VALUES(29,1795758173958233,'zoe','trainee','127.0.0.1','signIn','','{"name":"zoe","password":"(not kept)"}','8b894d70dd035657ac17900597e7cc5b8e663533af4bcaa8c9468cd80a52f9a6','');
INSERT INTO "audit" VALUES(30,1795758174573256,'admin','admin','127.0.0.1','makeEnrolmentCode','','{"name":"station-1"}','031e107daf38eb12dfe2a030aa98ce096dcacd7022d02ff88aab1f2fcabd99ca','');
INSERT INTO "audit" VALUES(31,1795758174590282,'station-1','station','127.0.0.1','enrolStation','','{"code":"(not kept)","token_sha256":"(not kept)"}','9dd79e82ecf7ae4bc8e66cf3b49dcd477bb707c22b29ebd02b5623c522ddf7d6','[["stations","[\"01a21b87317e7f2e4e53fd59019a9e95\"]","4c6d99a9c3209b52690646b7555ae746"]]');
INSERT INTO "audit" VALUES(32,1795758174610347,'admin','admin','127.0.0.1','makeEnrolmentCode','','{"name":"stolen"}','f5f6235be9fcb37d6900c5f120d3bafd046be3b4be75f4a82548809551956ce8','');
INSERT INTO "audit" VALUES(33,1795758174629913,'stolen','station','127.0.0.1','enrolStation','','{"code":"(not kept)","token_sha256":"(not kept)"}','a0743eab51887c925605bc9736c971b4c7aa880efe40a030a0a2a71c27985c8f','[["stations","[\"01a21b8731a6c6d77219213ebd4dcb33\"]","2c4c1365875bedec717b3704d3fa76ed"]]');
INSERT INTO "audit" VALUES(34,1795758174646227,'admin','admin','127.0.0.1','revokeStation','id=01a21b8731a6c6d77219213ebd4dcb33','{}','6601c8d8f299177a694dc62d0d04de95025231d02a27863d4ad36ad91e22c239','[["stations","[\"01a21b8731a6c6d77219213ebd4dcb33\"]","176825758e2e49b0620c212ab993b9bf"]]');
INSERT INTO "audit" VALUES(35,1795758174661906,'fay','faculty','127.0.0.1','addCohort','','{"name":"year 1"}','f43293f684ee97cde7479846fa75f29b38d421eb799a27a7b144e0d58fc7a1c0','[["cohorts","[\"01a21b8731c5be7f2dbd69b320b6b96e\"]","adc6be71c94bea89b9c465afa5bc23ce"],["cohort_people","[\"01a21b8731c5be7f2dbd69b320b6b96e\",\"01a21b86ef0d270c0713f2e70b977c1b\"]","9cbde165e952e51ac1718bb2b41cb3f7"]]');
INSERT INTO "audit" VALUES(36,1795758174674447,'admin','admin','127.0.0.1','putIntoCohort','id=01a21b8731c5be7f2dbd69b320b6b96e','{"name":"tom"}','2ffb34cd38ca5771a4272c052fac86bc07d7d4e9d8dd216fecd46dc98dddac88','[["cohort_people","[\"01a21b8731c5be7f2dbd69b320b6b96e\",\"01a21b87159550c045e5bdb289cfff5b\"]","4c3bb0f7ef0786a470afce28d7577f93"]]');
INSERT INTO "audit" VALUES(37,1795758174682090,'admin','admin','127.0.0.1','putIntoCohort','id=01a21b8731c5be7f2dbd69b320b6b96e','{"name":"zoe"}','1243fd45f958092d56957f0d1fc9ff88d00d58184e02a185adc5dd3437a88587','[["cohort_people","[\"01a21b8731c5be7f2dbd69b320b6b96e\",\"01a21b8725d6979005e224bcba929ed5\"]","d13f013ee8cd0cdaaba16fc40f0047af"]]');
INSERT INTO "audit" VALUES(38,1795758174701789,'tom','trainee','127.0.0.1','sayConsent','','{"tier":"full"}','5288490161168395f5a54e001616482157bf9f350fa36ba5c4d6b20f13dbdd5b','[["consents","[\"01a21b87159550c045e5bdb289cfff5b\",\"\",\"\"]","93cac7f22e2eeaaa6efce5790bcf2bca"]]');
INSERT INTO "audit" VALUES(39,1795758174721853,'zoe','trainee','127.0.0.1','sayConsent','','{"tier":"none"}','c590492017fff49d0d70a4e158ea9a4041a4935f9447ba21f8b1f14ce774a1a9','[["consents","[\"01a21b8725d6979005e224bcba929ed5\",\"\",\"\"]","0df266dc07f9bec089014f1a6007c9b0"]]');
INSERT INTO "audit" VALUES(40,1795758174723732,'fay','faculty','127.0.0.1','addAssignment','','{"title":"week 1","cases":[{"scenario":"(not kept)"}],"repeats":4,"seed":"(not kept)","release":"at_once","cohort":"01a21b8731c5be7f2dbd69b320b6b96e"}','b61a48f650a416608c0ccb6bff0a3fa6dd28ad1e64a15715f0ed39cfa2940f08','[["cases","[\"609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57\"]","4cf0ce6ddf1c40234475bd386f8eb28b"],["case_parts","[\"609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57\",\"scenario.json\"]","544046c64bd6205d4c86d680afcbf800"],["studies","[\"a-01a21b8732035ad97af1aec3\"]","351e493fdc36b24dfcf7066f3bd7b72b"],["study_scenarios","[\"a-01a21b8732035ad97af1aec3\",0]","89e71db1ac81ae55c46a7f55bda1c809"],["study_participants","[\"a-01a21b8732035ad97af1aec3\",\"Pexqtskrn\"]","3ed6ee67f437b0b24a3b1ecebebf116b"],["study_participants","[\"a-01a21b8732035ad97af1aec3\",\"Pf0qn30ka\"]","7466d5968bd6847ed15b162b1bebc954"],["study_slots","[\"027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457\"]","a28fe907c7f06061a7aa68036aac9541"],["study_slots","[\"2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec\"]","72093d6ee9d7e896c5ac188e6546841c"],["study_slots","[\"3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b\"]","9dc6f3cdc0f3fc80d605d9a41f3168c7"],["study_slots","[\"5f3dc7b62da7975677b6fc828bf88b2f715a684a0af18bae28e608bda5e174eb\"]","80752ba8bf6b3d1979fe50bc063c0145"],["study_slots","[\"a2bb76dda58ebce310839217d9dbf1efb177846405867d9df4d6fd1557f2f4cc\"]","5cf1f5e9e0f8ea17da718e01a884b37e"],["study_slots","[\"bd985e1885ca68e4fc928add7ffbccc615d0b956437d0f3fee4d2d246ba907c2\"]","71dea2848396ad7ce0a45da0d11dd38e"],["study_slots","[\"e78f23d1078cb32e2e0b3b24925568da79c22372e08c921dbd3c587085b26235\"]","c522579dbe5029b99aabcd56b8eb8cbe"],["study_slots","[\"edcc1b514f90e05cfb326784fd4e925b90f1574d265a243367c044be610c8883\"]","d817748ca3a8cad592b181de758376ba"],["study_events","[\"a-01a21b8732035ad97af1aec3\",1]","63d7a085f8da47f3ce926ef1bf5a5d82"],["study_events","[\"a-01a21b8732035ad97af1aec3\",2]","443d240150ef50ce238c5c01fe084a30"],["study_events","[\"a-01a21b8732035ad97af1aec3\",3]","e9ea5633c006dca81d4b90ccfb1ef300"],["assignments","[\"a-01a21b8732035ad97af1aec3\"]","ed74a1d2dfa2c775fc5915551e43c314"],["assignment_people","[\"a-01a21b8732035ad97af1aec3\",\"01a21b87159550c045e5bdb289cfff5b\"]","1f3612d6fc449009a8cdc03ff8b27a50"],["assignment_people","[\"a-01a21b8732035ad97af1aec3\",\"01a21b8725d6979005e224bcba929ed5\"]","62081983a6109984a4cb298dee9d3900"]]');
INSERT INTO "audit" VALUES(41,1795758174785537,'station-1','station','127.0.0.1','signInAtStation','','{"badge":"B-1","pin":"(not kept)"}','086972fa9678a87d09095f228b16df7d05bb014e929391272d6d1ca4684f7448','');
INSERT INTO "audit" VALUES(42,1795758175377187,'tom at station-1','trainee','127.0.0.1','nextTrial','','{"ticket":"(not kept)"}','9fe4dd4ad043001b5809b345ca48168636646ed11a1f43c6deea0e58a4ed3f15','[["study_slots","[\"027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457\"]","7768bd75c8e4597bb7c0a756f1bf077d"],["study_events","[\"a-01a21b8732035ad97af1aec3\",4]","c3c5d3a918a415b7b03104b198ff3c02"]]');
INSERT INTO "audit" VALUES(43,1795758175401449,'station-1','station','127.0.0.1','announceUpload','trial_id=ac24782dbaf7ce0495cbf2a77e1708d0','{"case_id":"027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457","size_bytes":8407,"sha256":"9b95cc05d15f77e633a89527918523840dcbd0e0e8c6fe1ec4890ff9d6fa7561"}','8cab41ec6c48d2f109fc3b39f963cae342729123ae447dbd15ea3c2f0a0906d3','[["study_trials","[\"ac24782dbaf7ce0495cbf2a77e1708d0\"]","4a5889c85c44b47fd4faef017cecae9a"]]');
INSERT INTO "audit" VALUES(44,1795758175445912,'station-1','station','127.0.0.1','commitUpload','trial_id=ac24782dbaf7ce0495cbf2a77e1708d0','{}','971c1196105a820c021e888801d718b8d78939b35f05f66471da0dc381da8aa5','[["study_slots","[\"027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457\"]","70792828a16bc9020c1f51d4de80ea64"],["study_trials","[\"ac24782dbaf7ce0495cbf2a77e1708d0\"]","75b2a750f45afed94c2385d172f4c1b5"],["study_events","[\"a-01a21b8732035ad97af1aec3\",5]","f6c1b8888fde348a048fa1d25fb4b751"],["trials","[\"ac24782dbaf7ce0495cbf2a77e1708d0\"]","4ea4fd98c90206340be0904b77784759"]]');
INSERT INTO "audit" VALUES(45,1795758175630454,'server','server','','serverWork','','{}','77b9c61cef60f1381421377677cd288d9caf6a4afd4df269decb4e54dcb7d377','[["trials","[\"ac24782dbaf7ce0495cbf2a77e1708d0\"]","eafb7d0a8d132a2438257b23ee4b53d1"],["trial_metrics","[\"ac24782dbaf7ce0495cbf2a77e1708d0\"]","3447224e3a1d2070a2d133bae1c09598"]]');
INSERT INTO "audit" VALUES(46,1795758175477954,'station-1','station','127.0.0.1','signInAtStation','','{"badge":"B-1","pin":"(not kept)"}','89f05cfc89bfa2e9437d2ffb80577b3ac66395d432fb06162cd2b874f50a53b7','');
INSERT INTO "audit" VALUES(47,1795758175981767,'tom at station-1','trainee','127.0.0.1','nextTrial','','{"ticket":"(not kept)"}','686416c9409621f20c3bbe49a71a1d602c2361fc302762e68c54eaf0e6f6a08b','[["study_slots","[\"3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b\"]","0ea1809f8f961ced437fd4f7b0646067"],["study_events","[\"a-01a21b8732035ad97af1aec3\",6]","ffa06a97f20b2fd7f0f0d6fb4f5caf31"]]');
INSERT INTO "audit" VALUES(48,1795758175995601,'station-1','station','127.0.0.1','announceUpload','trial_id=e4076927382719e4c0cbe2410d49aa8d','{"case_id":"3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b","size_bytes":8407,"sha256":"ef919ecd56c848728a551087bec6226158f895b52a0cc493ac2b8c606f5edbea"}','eb620598e2ad79d733dd0788a997f7fb62b7a0f8b6909c4da3ec5f7a7bb2401e','[["study_trials","[\"e4076927382719e4c0cbe2410d49aa8d\"]","78ab402914a3ca5b84c9218c85077c5b"]]');
INSERT INTO "audit" VALUES(49,1795758176025517,'station-1','station','127.0.0.1','commitUpload','trial_id=e4076927382719e4c0cbe2410d49aa8d','{}','fdad5866c2d2bc1c4ae6e941bff29a57380a06892c1da865bb7ef7b9cb86b13f','[["study_slots","[\"3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b\"]","77860c3652ded4bdc2618901a11c98a0"],["study_trials","[\"e4076927382719e4c0cbe2410d49aa8d\"]","1b783224df23498c2f620020b867aa3f"],["study_events","[\"a-01a21b8732035ad97af1aec3\",7]","73b283ab2a37b9b28e61a1c4b11a1a8a"],["trials","[\"e4076927382719e4c0cbe2410d49aa8d\"]","75d763516ace6995816388622f75ffef"]]');
INSERT INTO "audit" VALUES(50,1795758176066409,'server','server','','serverWork','','{}','14bf4183ec2b81bff3c29dc21d910de3465e80809066e28fbe988ef3873a4949','[["trials","[\"e4076927382719e4c0cbe2410d49aa8d\"]","bd4a192859ae24039449a98c40cb4897"],["trial_metrics","[\"e4076927382719e4c0cbe2410d49aa8d\"]","7928c7d5995f994d1c9c6f06d875115b"]]');
INSERT INTO "audit" VALUES(51,1795758176055057,'fay','faculty','127.0.0.1','addComment','id=ac24782dbaf7ce0495cbf2a77e1708d0','{"text":"(not kept)","at_s":0.1}','708fbb8d951e99e254330f441162d300035d9162b5df6b59b60d2a3f06d573c6','');
INSERT INTO "audit" VALUES(52,1795758176109163,'dora','director','127.0.0.1','addRubric','','{"id":"path","rubric":{"format":"tractus-rubric/1","title":"Path","items":"(not kept)"}}','323529306dfcc516f98eabbe1e7e6bfaa6ddcc8eb2249fbac66db429907e9c4c','[["rubrics","[\"path\",1]","22c563a164b9b3082d7b70b3f7a229ec"]]');
INSERT INTO "audit" VALUES(53,1795758176118217,'dora','director','127.0.0.1','askForRating','id=ac24782dbaf7ce0495cbf2a77e1708d0','{"rubric":"path"}','02b12b93c3cf567d140f36e05a148b3f3cde1581c84fefc4c16da0cd56dc7da2','[["rating_requests","[\"ac24782dbaf7ce0495cbf2a77e1708d0\",\"path\"]","422c7c92a39a5eb5ffeaee62336af1dc"]]');
INSERT INTO "audit" VALUES(54,1795758176137797,'fay','faculty','127.0.0.1','addRating','id=ac24782dbaf7ce0495cbf2a77e1708d0','{"rubric":"path","scores":"(not kept)","comment":"(not kept)"}','c4a5357ce84900379478a68d5b6459eb92f2d6acf81331e48a9f2e9acd9f016a','[["ratings","[\"ac24782dbaf7ce0495cbf2a77e1708d0\",\"path\",\"01a21b86ef0d270c0713f2e70b977c1b\",1]","48e77ae0ec271864995eeda156cf2142"]]');
INSERT INTO "audit" VALUES(55,1795758176165892,'dora','director','127.0.0.1','addCriteria','','{"case":"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575","reason":"our own rule","criteria":{"format":"tractus-criteria/1","requirements":[{"kind":"recognition","share":0.8,"last":5}]}}','7ea6c29d7670df7a71113d84fc691a52bafe3c2c7c214aac70e019e463bec4ec','[["criteria","[\"case\",\"d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575\",1]","f4ad1d398453c32b4474b6f1c4df2e33"]]');
INSERT INTO "audit" VALUES(56,1795758176189421,'dora','director','127.0.0.1','addCurriculum','','{"title":"First year","reason":"begins","steps":[{"id":"a","name":"Hard bone","cases":[{"scenario":"(not kept)"}],"repeats":2,"after":[],"criteria":{"format":"tractus-criteria/1","requirements":[{"kind":"recognition","share":0.8,"last":5}]}}]}','e5df926fa9ddcdd0030062366bb0217a42bda3fed2b1d4666a284c046d34c6f6','[["cases","[\"609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57\"]","4cf0ce6ddf1c40234475bd386f8eb28b"],["curricula","[\"01a21b8737bdb0322e9414ad\",1]","b74a51c1240c5d1a7b2a863861eb3895"]]');
INSERT INTO "audit" VALUES(57,1795758176198107,'rob','researcher','127.0.0.1','makeStudy','','{"id":"blind","title":"A blind study","repeats":1,"ordering":"random","seed":"(not kept)","scenarios":[{"tuned":"soft"},{"tuned":"lateral_breach"}],"participants":[{"name":"S01"},{"name":"S02"}]}','f08367700b51426b7a60190a2ecdfc08c347d1137937ad4ff1dccca998d4b76a','[["cases","[\"6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6\"]","476ca30c4acfb76179298c37fda55a87"],["cases","[\"cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259\"]","501461cbc02e57eadc00cef28b4bfb85"],["case_parts","[\"6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6\",\"scenario.json\"]","d80fb0dcabfeeddcf5a497d595fda0a6"],["case_parts","[\"cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259\",\"scenario.json\"]","72baf8c86d06f0c75096e0980996fbb6"],["studies","[\"blind\"]","e35de3f865c90e6482301a9c7ecbc627"],["study_scenarios","[\"blind\",0]","5a10d5e6942da695a3af8b1bc0862daf"],["study_scenarios","[\"blind\",1]","7a93081612599ffca30ad45d0f148905"],["study_participants","[\"blind\",\"S01\"]","b80f6abf76110b81aebb9e14dd27c219"],["study_participants","[\"blind\",\"S02\"]","757ba2891329d9ad6e2c96e043e1444d"],["study_slots","[\"3bdde79f3517eceb1be8c0b9a7acfb9b2f0e9bf7df6bb35996ff9f5004d12edd\"]","334efc369eca781417ebd7bb3e2374a9"],["study_slots","[\"a7debf493ba33531d0c0bc908d7debb511575fd3b7345125ca2cc339704bc1f6\"]","d61bb122ca0d59819e85698ee5061c2d"],["study_slots","[\"dcb4e583f8d2d0dc758e382c39598b45e939fd6b94c2b0512a1a135c879f5558\"]","0e8a238f52afca24a01844f9b466b40d"],["study_slots","[\"f9208a4644f7b8e2c9297f62ac9eab107f900142df85f84f62140b1e1f58a5d8\"]","ebfdeedee925981ddff99d4feff5c6ba"],["study_events","[\"blind\",1]","f12c74aba70c07aadbdfc28b7fd70c46"],["study_events","[\"blind\",2]","2c1e7b0819300ea3416257a29b626b7d"],["study_events","[\"blind\",3]","40bab0b6201f4f07c643b1f900032ad2"]]');
INSERT INTO "audit" VALUES(58,1795758176254895,'rob','researcher','127.0.0.1','lockAnalysisPlan','','{"plan":{"format":"tractus-plan/1","title":"A plan","question":"(not kept)","subject":"participant","analyses":"(not kept)"}}','58f430ab24ac614e03bb6c35a0fa6fe6e1bebd5c3246e864b7ff5f4256bb84e9','[["analysis_plans","[\"01a21b8737ff924c9528846b153d4612\"]","7b4a928ced413b8416ee759998eebdaf"]]');
INSERT INTO "audit" VALUES(59,1795758176303572,'rob','researcher','127.0.0.1','addMeasurements','','{}','e85c2327e3e66f066c95112c88a3c7f2d7f51b1ab1e4d701cb7ed6d01340ec1d','');
INSERT INTO "audit" VALUES(60,1795758176381910,'rob','researcher','127.0.0.1','addModel','','{"format":"tractus-model/1","rig":"probing","name":"a cable with a spring and a damper","base":"(not kept)","effects":"(not kept)"}','368074a8c99f3604d381a9b359d3b5693253bb1d25d68bf98b27201274e88066','');
INSERT INTO "audit" VALUES(61,1795758176437425,'rob','researcher','127.0.0.1','startComparison','','{"model":"01a21b87387edb24d8ff33a3cbbc2af3","measurements":"aa6ca7c25bf24f3cda78e92ba15370083e2d64489d825fa05d2d3797d7312163"}','8bae81b725df0dbcfda0c45a8f30f665d3c178c46019e525b65bf4a6c1f8f5b9','');
INSERT INTO "audit" VALUES(62,1795758176453318,'rob','researcher','127.0.0.1','makeApiToken','','{"name":"notebook","scopes":["studies:read","lab:read"],"password":"(not kept)","expires_utc_us":1821678176452556}','aeeb740ee19a707af3359d3e866c2c4232535db5a023fae0045e24a2027e680c','[["api_tokens","[\"01a21b8738c57d193778145b099d329a\"]","f6da803d17bf99dea57673ebe01faaa8"]]');
INSERT INTO "audit" VALUES(63,1795758176969186,'tom','trainee','127.0.0.1','setNotifications','','{"address":"(not kept)","choices":[{"kind":"released","delivery":"daily"}]}','0d2f73d2742a40ea2d50f0a2f432f3361bb6c605d79f2048ea5c66980a6d1bdc','[["notification_addresses","[\"01a21b87159550c045e5bdb289cfff5b\"]","41753ef6995e84bfae5d711329275aab"]]');
INSERT INTO "audit" VALUES(64,1795758177033731,'fay','faculty','127.0.0.1','saveView','','{"page":"(not kept)","name":"hard bone","search":"(not kept)"}','d0c3980d2b95879a85bd7af19f3fdd7415f630ec6ae8b48568df69cb784a92d9','');
INSERT INTO "audit" VALUES(65,1795758177041135,'station-1','station','127.0.0.1','signInAtStation','','{"badge":"B-1","pin":"(not kept)"}','12b6b06953be16204788623cdba68fb5c6d2a1ed7d0bacc311ee2723a70e6a34','');
INSERT INTO "audit" VALUES(66,1795758177589352,'tom at station-1','trainee','127.0.0.1','nextTrial','','{"ticket":"(not kept)"}','b4b3e9ccf22f5fb374d3310ff6981c17dbee3325f8da74f361fab40a554e352f','[["study_slots","[\"2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec\"]","0bd80c417998007c6ce79830ceab6a31"],["study_events","[\"a-01a21b8732035ad97af1aec3\",8]","a65f37cf6f3ef341d7d549dc23992c4c"]]');
INSERT INTO "audit" VALUES(67,1795758177607857,'station-1','station','127.0.0.1','announceUpload','trial_id=b35e0d379eb5a75f4e9355dc753181ff','{"case_id":"2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec","size_bytes":8407,"sha256":"d8be5723312ffa78a9b9750cb2cfe918ed43de624687c67571e15c5ed4f2cd1c"}','815e8c3473ae1e8ffa823805a2e6848e375ebf3ebc1aaa9892a4474c7c12e2bd','[["study_trials","[\"b35e0d379eb5a75f4e9355dc753181ff\"]","a47fe0fb9fabd5e4160e8345bd8d4908"]]');
CREATE TABLE case_makings (
  id text primary key,
  volume_id text not null,
  title text not null,
  plan text not null,
  state text not null,
  share double precision not null,
  phase text not null,
  error text not null,
  case_id text references cases (id),
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
CREATE TABLE case_parts (
  case_id text not null references cases (id),
  name text not null,
  sha256 text not null references objects (sha256),
  size_bytes bigint not null,
  secret bigint not null,
  primary key (case_id, name)
);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','case.json','d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575',1803,0);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','case.sig','a2ea6286ff53319681977f09af69bcc37dce5ec8f383a7ae4f3b1450f0aae9ae',269,0);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','volume.tvol','4e22a3f9877a842e10f2697ac2681b7ae0274974993df3887d0b4c785a0cdcb2',1625,0);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','truth.json','2dbe4375cf38c678c106942e02394755eb678dfd19a65a3e43078d5e633b6d6d',1024,1);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','picture.png','125ff83647f9a3d16d35179f986b6af8a838d9fcff3c9232b3e72a50548cba66',524288,1);
INSERT INTO "case_parts" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','certificate.json','2eb9a4302205327c6391b51f73b91157ea1a1236c17511003b866571ff7d60a7',65536,1);
INSERT INTO "case_parts" VALUES('609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','scenario.json','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57',658,1);
INSERT INTO "case_parts" VALUES('6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6','scenario.json','6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6',658,1);
INSERT INTO "case_parts" VALUES('cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259','scenario.json','cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259',571,1);
CREATE TABLE cases (
  id text primary key,
  title text not null,
  source text not null,
  made_utc_us bigint not null,
  published_utc_us bigint not null
, kind text not null default 'palpation', retired_utc_us bigint, planned bigint not null default 0, felt text not null default 'untried');
INSERT INTO "cases" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575','Simulated block','made by a program, no patient',1795756976121069,1795758151405148,'palpation',NULL,0,'not_told');
INSERT INTO "cases" VALUES('609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','Hard bone','Tractus (own choice within the published limits)',1795758174746725,1795758174746725,'probing',NULL,0,'untried');
INSERT INTO "cases" VALUES('6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6','Soft bone','Tractus (own choice within the published limits)',1795758176245163,1795758176245163,'probing',NULL,0,'untried');
INSERT INTO "cases" VALUES('cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259','Lateral breach','Tractus (own choice within the published limits)',1795758176245163,1795758176245163,'probing',NULL,0,'untried');
CREATE TABLE cohort_invitations (
  cohort_id text not null references cohorts (id),
  account_name text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (cohort_id, account_name)
);
CREATE TABLE cohort_people (
  cohort_id text not null references cohorts (id),
  account_id text not null references accounts (id),
  part text not null,
  since_utc_us bigint not null,
  primary key (cohort_id, account_id)
);
INSERT INTO "cohort_people" VALUES('01a21b8731c5be7f2dbd69b320b6b96e','01a21b86ef0d270c0713f2e70b977c1b','faculty',1795758174661923);
INSERT INTO "cohort_people" VALUES('01a21b8731c5be7f2dbd69b320b6b96e','01a21b87159550c045e5bdb289cfff5b','trainee',1795758174674579);
INSERT INTO "cohort_people" VALUES('01a21b8731c5be7f2dbd69b320b6b96e','01a21b8725d6979005e224bcba929ed5','trainee',1795758174682117);
CREATE TABLE cohorts (
  id text primary key,
  name text not null unique,
  made_utc_us bigint not null,
  made_by text not null
);
INSERT INTO "cohorts" VALUES('01a21b8731c5be7f2dbd69b320b6b96e','year 1',1795758174661923,'fay');
CREATE TABLE consents (
  account_id text not null,
  study_id text not null,
  participant text not null,
  tier text not null,
  basis text not null,
  noted_utc_us bigint not null,
  noted_by text not null,
  primary key (account_id, study_id, participant)
);
INSERT INTO "consents" VALUES('01a21b87159550c045e5bdb289cfff5b','','','full','own word',1795758174701810,'tom');
INSERT INTO "consents" VALUES('01a21b8725d6979005e224bcba929ed5','','','none','own word',1795758174721858,'zoe');
CREATE TABLE criteria (
  kind text not null,
  subject text not null,
  version bigint not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (kind, subject, version)
);
INSERT INTO "criteria" VALUES('case','d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575',1,'{"format":"tractus-criteria/1","requirements":[{"kind":"recognition","share":0.8,"level":0.95,"last":5,"basis":""}]}','our own rule',1795758176165938,'dora');
CREATE TABLE curricula (
  id text not null,
  version bigint not null,
  title text not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (id, version)
);
INSERT INTO "curricula" VALUES('01a21b8737bdb0322e9414ad',1,'First year','{"format":"tractus-curriculum/1","steps":[{"id":"a","name":"Hard bone","cases":["609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57"],"repeats":2,"after":[],"criteria":{"format":"tractus-criteria/1","requirements":[{"kind":"recognition","share":0.8,"level":0.95,"last":5,"basis":""}]}}]}','begins',1795758176189744,'dora');
CREATE TABLE curriculum_steps (
  study_id text primary key references assignments (study_id),
  curriculum_id text not null,
  version bigint not null,
  step_id text not null,
  foreign key (curriculum_id, version) references curricula (id, version)
);
CREATE TABLE deliveries (
  id text primary key,
  channel text not null,
  recipient text not null,
  batch text unique,
  state text not null,
  attempts bigint not null,
  made_utc_us bigint not null,
  due_utc_us bigint not null,
  claimed_until_us bigint not null,
  changed_utc_us bigint not null,
  error text not null
);
CREATE TABLE delivery_events (
  delivery_id text not null references deliveries (id),
  event_id text not null references notification_events (id),
  primary key (delivery_id, event_id)
);
CREATE TABLE enrolment_codes (
  code_hash text primary key,
  station_name text not null,
  made_utc_us bigint not null,
  expires_utc_us bigint not null,
  used_utc_us bigint
);
INSERT INTO "enrolment_codes" VALUES('d6529c6c53a6859f42d2896022d982e0d1487257e5bfca07427b06d9b4c8407d','station-1',1795758174573274,1795761774573274,1795758174590423);
INSERT INTO "enrolment_codes" VALUES('8ec7294d356aa76b8a9a572c13f3e8bba3cfa6df7e77ec5ea1318c8256d46fe6','stolen',1795758174610358,1795761774610358,1795758174630074);
CREATE TABLE erased_slots (
  slot_id text primary key,
  erasure bigint not null references erasures (number)
);
CREATE TABLE erased_trials (
  trial_id text primary key,
  erasure bigint not null references erasures (number),
  sha256 text not null,
  deleted bigint not null
);
CREATE TABLE erasures (
  number bigint primary key,
  account_id text not null unique references accounts (id),
  mode text not null,
  cause text not null,
  state text not null,
  name text not null,
  badge text not null,
  begun_utc_us bigint not null,
  done_utc_us bigint
);
CREATE TABLE group_accounts (
  account_id text primary key references accounts (id),
  version bigint not null references group_rules (version),
  seen_utc_us bigint not null,
  left_utc_us bigint
);
CREATE TABLE group_rules (
  version bigint primary key,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null
);
CREATE TABLE jobs (
  id text primary key,
  kind text not null,
  subject text not null,
  state text not null,
  attempts bigint not null,
  error text not null,
  queued_utc_us bigint not null,
  changed_utc_us bigint not null
, owner text not null default '', lease_until_utc_us bigint not null default 0);
INSERT INTO "jobs" VALUES('01a21b8734ea59145c7e182f1033a1e2','metrics','ac24782dbaf7ce0495cbf2a77e1708d0','done',1,'',1795758175465019,1795758175645120,'01a21b86d905ba170b74e628c8f312ee',1795758205485047);
INSERT INTO "jobs" VALUES('01a21b87373181851265d1b2afbe0379','metrics','e4076927382719e4c0cbe2410d49aa8d','done',1,'',1795758176049021,1795758176081525,'01a21b86d905ba170b74e628c8f312ee',1795758206053615);
INSERT INTO "jobs" VALUES('01a21b8738b598bec4bc267ebd6b5bee','lab','01a21b8738b5b02b2821eb19920baf9a','done',1,'',1795758176437444,1795758176992593,'01a21b86d905ba170b74e628c8f312ee',1795758206457024);
CREATE TABLE known_origins (
  account_id text not null references accounts (id) on delete cascade,
  secret text not null,
  origin text not null,
  seen_utc_us bigint not null,
  primary key (account_id, secret, origin)
);
INSERT INTO "known_origins" VALUES('01a21b86d36332f4f324ce8ab79d9fe9','account_password','127.0.0.1',1795758153470847);
INSERT INTO "known_origins" VALUES('01a21b86df21810c9438848f2126c10f','account_password','127.0.0.1',1795758157460250);
INSERT INTO "known_origins" VALUES('01a21b86ef0d270c0713f2e70b977c1b','account_password','127.0.0.1',1795758160832558);
INSERT INTO "known_origins" VALUES('01a21b86fc0232e2db6529ea19525186','account_password','127.0.0.1',1795758163820023);
INSERT INTO "known_origins" VALUES('01a21b870785cec8c961993482eec74f','account_password','127.0.0.1',1795758167414623);
INSERT INTO "known_origins" VALUES('01a21b87159550c045e5bdb289cfff5b','account_password','127.0.0.1',1795758171591892);
INSERT INTO "known_origins" VALUES('01a21b8725d6979005e224bcba929ed5','account_password','127.0.0.1',1795758174533406);
INSERT INTO "known_origins" VALUES('01a21b87159550c045e5bdb289cfff5b','badge_pin','01a21b87317e7f2e4e53fd59019a9e95',1795758177569596);
CREATE TABLE lab_runs (
  id text primary key,
  kind text not null,
  model_id text not null references models (id),
  against_id text references models (id),
  set_id text not null references measurement_sets (id),
  wish text not null,
  state text not null,
  share double precision not null,
  phase text not null,
  stop bigint not null,
  ranking text,
  result text references objects (sha256),
  report text references objects (sha256),
  samples text references objects (sha256),
  model_sha256 text references objects (sha256),
  error text not null,
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
INSERT INTO "lab_runs" VALUES('01a21b8738b5b02b2821eb19920baf9a','comparison','01a21b87387edb24d8ff33a3cbbc2af3',NULL,'aa6ca7c25bf24f3cda78e92ba15370083e2d64489d825fa05d2d3797d7312163','{"add":[],"own":[]}','done',1.0,'',0,NULL,'4bc274ef88bf195dc00137bacb716007980f9e3c22b6afb8c485401e86ab661a',NULL,'b5fcede96e414ff20dd83a0609939f6db321a0f0eed6201e4a486a120d5e315a',NULL,'',1795758176437444,'rob',1795758176965988);
CREATE TABLE measurement_sets (
  id text primary key references objects (sha256),
  name text not null,
  made_utc_us bigint not null,
  made_by text not null
, rig text, simulated bigint, trials bigint, samples bigint);
INSERT INTO "measurement_sets" VALUES('aa6ca7c25bf24f3cda78e92ba15370083e2d64489d825fa05d2d3797d7312163','cable',1795758176353063,'rob','probing',0,2,300);
CREATE TABLE models (
  id text primary key,
  name text not null,
  rig text not null,
  sha256 text not null references objects (sha256),
  parent text references models (id),
  run_id text,
  made_utc_us bigint not null,
  made_by text not null
, note text not null default '');
INSERT INTO "models" VALUES('01a21b87387edb24d8ff33a3cbbc2af3','a cable with a spring and a damper','probing','9db1bfc67a9f5e782cecfc159fef6923a43ccb4eee6a0fa78a1ca9369ad02a59',NULL,NULL,1795758176382017,'rob','');
CREATE TABLE notification_addresses (
  account_id text primary key references accounts (id),
  address text not null
);
INSERT INTO "notification_addresses" VALUES('01a21b87159550c045e5bdb289cfff5b','tom@example.org');
CREATE TABLE notification_choices (
  account_id text not null references accounts (id),
  kind text not null,
  delivery text not null,
  primary key (account_id, kind)
);
INSERT INTO "notification_choices" VALUES('01a21b87159550c045e5bdb289cfff5b','released','daily');
CREATE TABLE notification_events (
  id text primary key,
  kind text not null,
  key text not null unique,
  subject text not null,
  at_utc_us bigint not null,
  spread bigint not null
);
CREATE TABLE objects (
  sha256 text primary key,
  size_bytes bigint not null,
  made_utc_us bigint not null
);
INSERT INTO "objects" VALUES('d4d372bf5be2ebd1f833774e9f6139e65182e33ef4c80ffd63041f8590a43575',1803,1795758151405148);
INSERT INTO "objects" VALUES('a2ea6286ff53319681977f09af69bcc37dce5ec8f383a7ae4f3b1450f0aae9ae',269,1795758151405148);
INSERT INTO "objects" VALUES('4e22a3f9877a842e10f2697ac2681b7ae0274974993df3887d0b4c785a0cdcb2',1625,1795758151405148);
INSERT INTO "objects" VALUES('2dbe4375cf38c678c106942e02394755eb678dfd19a65a3e43078d5e633b6d6d',1024,1795758151405148);
INSERT INTO "objects" VALUES('125ff83647f9a3d16d35179f986b6af8a838d9fcff3c9232b3e72a50548cba66',524288,1795758151405148);
INSERT INTO "objects" VALUES('2eb9a4302205327c6391b51f73b91157ea1a1236c17511003b866571ff7d60a7',65536,1795758151405148);
INSERT INTO "objects" VALUES('609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57',658,1795758174746725);
INSERT INTO "objects" VALUES('9b95cc05d15f77e633a89527918523840dcbd0e0e8c6fe1ec4890ff9d6fa7561',8407,1795758175465019);
INSERT INTO "objects" VALUES('ef919ecd56c848728a551087bec6226158f895b52a0cc493ac2b8c606f5edbea',8407,1795758176049021);
INSERT INTO "objects" VALUES('6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6',658,1795758176245163);
INSERT INTO "objects" VALUES('cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259',571,1795758176245163);
INSERT INTO "objects" VALUES('df675fa021d649a2696eb52a262e3419edcabfb46b8a8b328c031f43795ea404',456,1795758176255073);
INSERT INTO "objects" VALUES('aa6ca7c25bf24f3cda78e92ba15370083e2d64489d825fa05d2d3797d7312163',3475,1795758176353063);
INSERT INTO "objects" VALUES('9db1bfc67a9f5e782cecfc159fef6923a43ccb4eee6a0fa78a1ca9369ad02a59',415,1795758176382017);
INSERT INTO "objects" VALUES('4bc274ef88bf195dc00137bacb716007980f9e3c22b6afb8c485401e86ab661a',7357,1795758176965988);
INSERT INTO "objects" VALUES('b5fcede96e414ff20dd83a0609939f6db321a0f0eed6201e4a486a120d5e315a',5280,1795758176965988);
CREATE TABLE oidc_subjects (
  issuer text not null,
  subject text not null,
  account_id text not null references accounts (id),
  linked_utc_us bigint not null,
  linked_by text not null,
  primary key (issuer, subject)
);
CREATE TABLE pseudonym_keys (
  fingerprint text primary key,
  since_utc_us bigint not null
);
INSERT INTO "pseudonym_keys" VALUES('6019cc564e9b494d6bba1c801da721e1',1795758151917143);
CREATE TABLE rating_requests (
  trial_id text not null references trials (id),
  rubric_id text not null,
  version bigint not null,
  blind bigint not null,
  raters bigint not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (trial_id, rubric_id),
  foreign key (rubric_id, version) references rubrics (id, version)
);
INSERT INTO "rating_requests" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','path',1,0,2,1795758176118220,'dora');
CREATE TABLE ratings (
  trial_id text not null,
  rubric_id text not null,
  rater_id text not null references accounts (id),
  number bigint not null,
  scores text not null,
  comment text not null,
  reason text not null,
  independent bigint not null,
  made_utc_us bigint not null,
  primary key (trial_id, rubric_id, rater_id, number),
  foreign key (trial_id, rubric_id) references rating_requests (trial_id, rubric_id)
);
INSERT INTO "ratings" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','path','01a21b86ef0d270c0713f2e70b977c1b',1,'[4]','nearly','',1,1795758176137806);
CREATE TABLE redactions (
  number bigint primary key references audit (number),
  digest text not null
);
CREATE TABLE reference_trials (
  trial_id text primary key references trials (id),
  made_utc_us bigint not null,
  made_by text not null
);
CREATE TABLE retention_notices (
  account_id text primary key references accounts (id),
  version bigint not null references retention_rules (version),
  noticed_utc_us bigint not null,
  acts_utc_us bigint not null
);
CREATE TABLE retention_rules (
  version bigint primary key,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null
);
CREATE TABLE rubrics (
  id text not null,
  version bigint not null,
  title text not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (id, version)
);
INSERT INTO "rubrics" VALUES('path',1,'Path','{"format":"tractus-rubric/1","title":"Path","items":[{"label":"Path","text":"","low":1,"high":5,"low_text":"strays","middle_text":"corrects itself","high_text":"straight"}]}','',1795758176109173,'dora');
CREATE TABLE saved_views (
  id text primary key,
  account_id text not null references accounts (id),
  page text not null,
  name text not null,
  search text not null,
  made_utc_us bigint not null,
  unique (account_id, page, name)
);
INSERT INTO "saved_views" VALUES('01a21b873b093d34d07f9dad43c51d6f','01a21b86ef0d270c0713f2e70b977c1b','trials','hard bone','q=hard',1795758177033750);
CREATE TABLE scenario_versions (
  id text primary key,
  sha256 text not null references objects (sha256),
  name text not null,
  kind text not null,
  parent text,
  published bigint not null,
  made_utc_us bigint not null,
  made_by text not null
);
CREATE TABLE schema_versions (version bigint primary key, name text not null, applied_utc_us bigint not null);
INSERT INTO "schema_versions" VALUES(1,'first',1795758149439936);
INSERT INTO "schema_versions" VALUES(2,'studies',1795758149452089);
INSERT INTO "schema_versions" VALUES(3,'lab',1795758149452576);
INSERT INTO "schema_versions" VALUES(4,'analyses',1795758149461315);
INSERT INTO "schema_versions" VALUES(5,'lab_runs',1795758149487086);
INSERT INTO "schema_versions" VALUES(6,'people',1795758149514868);
INSERT INTO "schema_versions" VALUES(7,'audit',1795758149515025);
INSERT INTO "schema_versions" VALUES(8,'leases',1795758149516464);
INSERT INTO "schema_versions" VALUES(9,'stations_at_work',1795758149516877);
INSERT INTO "schema_versions" VALUES(10,'volumes',1795758149525213);
INSERT INTO "schema_versions" VALUES(11,'consent',1795758149525720);
INSERT INTO "schema_versions" VALUES(12,'teaching',1795758149527358);
INSERT INTO "schema_versions" VALUES(13,'sent_models',1795758149527481);
INSERT INTO "schema_versions" VALUES(14,'uploads_by_file',1795758149579763);
INSERT INTO "schema_versions" VALUES(15,'drilling',1795758149593903);
INSERT INTO "schema_versions" VALUES(16,'relations',1795758149595089);
INSERT INTO "schema_versions" VALUES(17,'sign_ins',1795758149595717);
INSERT INTO "schema_versions" VALUES(18,'row_digests',1795758149596737);
INSERT INTO "schema_versions" VALUES(19,'levels',1795758149614009);
INSERT INTO "schema_versions" VALUES(20,'criteria',1795758149614515);
INSERT INTO "schema_versions" VALUES(21,'felt',1795758149615486);
INSERT INTO "schema_versions" VALUES(22,'finding',1795758149631227);
INSERT INTO "schema_versions" VALUES(23,'ratings',1795758149631822);
INSERT INTO "schema_versions" VALUES(24,'tokens',1795758149632216);
INSERT INTO "schema_versions" VALUES(25,'notifications',1795758149645846);
INSERT INTO "schema_versions" VALUES(26,'leaving',1795758149646910);
INSERT INTO "schema_versions" VALUES(27,'group_rules',1795758149647221);
CREATE TABLE sessions (
  token_hash text primary key,
  account_id text not null references accounts (id) on delete cascade,
  made_utc_us bigint not null,
  seen_utc_us bigint not null
);
INSERT INTO "sessions" VALUES('368028fbbf3085e4876ddbf98a4c557288624025e29162e5d7212cc6f1db3e75','01a21b86d36332f4f324ce8ab79d9fe9',1795758153470847,1795758153470847);
INSERT INTO "sessions" VALUES('3ac991164ba1408a01c6fc4d98df99a05d4fd47437abc2f4d504c1dd3e03f2e4','01a21b86df21810c9438848f2126c10f',1795758155308495,1795758155308495);
INSERT INTO "sessions" VALUES('85ed1423131f7ea67ead542a5d1feb186003fd6636ebe43cd14941b955496ed3','01a21b86df21810c9438848f2126c10f',1795758157460250,1795758157460250);
INSERT INTO "sessions" VALUES('4ccbd705a16578d7b5584cf124b16ac31b74f51e1c260930036f54a3cfde6207','01a21b86ef0d270c0713f2e70b977c1b',1795758159340420,1795758159340420);
INSERT INTO "sessions" VALUES('f43452a6b24decdffa7b08a71ae2fcc206d6f9e4fa6207d537a7c97927564084','01a21b86ef0d270c0713f2e70b977c1b',1795758160832558,1795758160832558);
INSERT INTO "sessions" VALUES('739ce12d1456336c7c03269512426378a8e511e71532ca0a27771fedcce9216d','01a21b86fc0232e2db6529ea19525186',1795758162068117,1795758162068117);
INSERT INTO "sessions" VALUES('dbc3719a7c238dde97fadbbe5658252b90dd97348d84ca75500d24694fa8bc57','01a21b86fc0232e2db6529ea19525186',1795758163820023,1795758163820023);
INSERT INTO "sessions" VALUES('071cc7e1357cffc8a1380c56fda36b1fdee25d5f3e0d51e6682f4cc60b011c76','01a21b870785cec8c961993482eec74f',1795758165227059,1795758165227059);
INSERT INTO "sessions" VALUES('df64ff8c9ea9ac0d0915c9840162225a26faf6f47903835742bccf6950e3a9e4','01a21b870785cec8c961993482eec74f',1795758167414623,1795758167414623);
INSERT INTO "sessions" VALUES('d5a1e9c86c6b60584095af3ef662dea2b013be70ac3778204f7d60492b8839b8','01a21b87159550c045e5bdb289cfff5b',1795758169505100,1795758169505100);
INSERT INTO "sessions" VALUES('9b02ef8f0a7355a1e1cec30f16202b344a164a195d1ccb447d719a8baa0e77f7','01a21b87159550c045e5bdb289cfff5b',1795758171591892,1795758171591892);
INSERT INTO "sessions" VALUES('0a65be1641cd79d465841f67270a5c978ba343d3e141b7b2a921a0022d5df64e','01a21b8725d6979005e224bcba929ed5',1795758172828799,1795758172828799);
INSERT INTO "sessions" VALUES('c281aef3fea63b7f8b9accf65a9dc5b1f3fdd5036c64cca11891a195ceaa7ab5','01a21b8725d6979005e224bcba929ed5',1795758174533406,1795758174533406);
INSERT INTO "sessions" VALUES('9a1ce9584734daa59863210feea5191564924da549859afa03059c6f1fe57092','01a21b87159550c045e5bdb289cfff5b',1795758175331030,1795758175377393);
INSERT INTO "sessions" VALUES('4866914b80a631c53d546967d134744a1cbfc043e1702a419184213cb51f192e','01a21b87159550c045e5bdb289cfff5b',1795758175961491,1795758175981862);
INSERT INTO "sessions" VALUES('0faf1386e947b09d6df23e1970f6b307b5e18de4c5dd95db9dd68fc09e343b8c','01a21b87159550c045e5bdb289cfff5b',1795758177569596,1795758177589454);
CREATE TABLE sign_in_failures (
  secret text not null,
  total text not null,
  name text not null,
  origin text not null,
  failures double precision not null,
  at_utc_us bigint not null,
  primary key (secret, total, name, origin)
);
CREATE TABLE station_models (
  station_id text not null references stations (id),
  model_id text not null references models (id),
  asked_utc_us bigint not null,
  asked_by text not null,
  there_utc_us bigint,
  primary key (station_id, model_id)
);
CREATE TABLE station_reports (
  station_id text not null references stations (id),
  kind text not null,
  at_utc_us bigint not null,
  received_utc_us bigint not null,
  body text not null,
  primary key (station_id, kind, at_utc_us)
);
CREATE TABLE station_states (
  station_id text primary key references stations (id),
  seen_utc_us bigint not null,
  told text not null
);
CREATE TABLE stations (
  id text primary key,
  name text not null unique,
  token_hash text not null unique,
  enrolled_utc_us bigint not null
, revoked_utc_us bigint);
INSERT INTO "stations" VALUES('01a21b87317e7f2e4e53fd59019a9e95','station-1','cd36679ed0f3d8dd62778b2f2a380fe30ad079de025f9cafb9be5aa726443e9d',1795758174590423,NULL);
INSERT INTO "stations" VALUES('01a21b8731a6c6d77219213ebd4dcb33','stolen','9b6cbd31d7c9addfd1dbf3cdba55ffbfad766c580607231d8ef5defc26b11637',1795758174630074,1795758174646252);
CREATE TABLE studies (
  id text primary key,
  title text not null,
  state text not null,
  ordering text not null,
  repeats bigint not null,
  seed bigint not null,
  on_invalid text not null,
  made_utc_us bigint not null,
  made_by text not null
, kind text not null default 'study');
INSERT INTO "studies" VALUES('a-01a21b8732035ad97af1aec3','week 1','running','random',4,1,'at_end',1795758174746725,'fay','assignment');
INSERT INTO "studies" VALUES('blind','A blind study','running','random',1,1,'at_end',1795758176245163,'rob','study');
CREATE TABLE study_events (
  study_id text not null references studies (id),
  number bigint not null,
  at_utc_us bigint not null,
  who text not null,
  what text not null,
  participant text,
  slot_id text,
  trial_id text,
  reason text not null,
  primary key (study_id, number)
);
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',1,1795758174746725,'fay','made',NULL,NULL,NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',2,1795758174746725,'fay','enrolled','Pexqtskrn',NULL,NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',3,1795758174746725,'fay','enrolled','Pf0qn30ka',NULL,NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',4,1795758175377633,'station-1','taken','Pexqtskrn','027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457',NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',5,1795758175465019,'station-1','recorded','Pexqtskrn','027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457','ac24782dbaf7ce0495cbf2a77e1708d0','');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',6,1795758175982010,'station-1','taken','Pexqtskrn','3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b',NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',7,1795758176049021,'station-1','recorded','Pexqtskrn','3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b','e4076927382719e4c0cbe2410d49aa8d','');
INSERT INTO "study_events" VALUES('blind',1,1795758176245163,'rob','made',NULL,NULL,NULL,'');
INSERT INTO "study_events" VALUES('blind',2,1795758176245163,'rob','enrolled','S01',NULL,NULL,'');
INSERT INTO "study_events" VALUES('blind',3,1795758176245163,'rob','enrolled','S02',NULL,NULL,'');
INSERT INTO "study_events" VALUES('a-01a21b8732035ad97af1aec3',8,1795758177589585,'station-1','taken','Pexqtskrn','2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec',NULL,'');
CREATE TABLE study_participants (
  study_id text not null references studies (id),
  name text not null,
  position bigint not null,
  state text not null,
  level text not null,
  experience_years double precision,
  simulated bigint not null,
  enrolled_utc_us bigint not null,
  primary key (study_id, name)
);
INSERT INTO "study_participants" VALUES('a-01a21b8732035ad97af1aec3','Pexqtskrn',0,'running','',NULL,0,1795758174746725);
INSERT INTO "study_participants" VALUES('a-01a21b8732035ad97af1aec3','Pf0qn30ka',1,'running','',NULL,0,1795758174746725);
INSERT INTO "study_participants" VALUES('blind','S01',0,'running','',NULL,0,1795758176245163);
INSERT INTO "study_participants" VALUES('blind','S02',1,'running','',NULL,0,1795758176245163);
CREATE TABLE study_scenarios (
  study_id text not null references studies (id),
  position bigint not null,
  case_id text not null references cases (id),
  primary key (study_id, position)
);
INSERT INTO "study_scenarios" VALUES('a-01a21b8732035ad97af1aec3',0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57');
INSERT INTO "study_scenarios" VALUES('blind',0,'6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6');
INSERT INTO "study_scenarios" VALUES('blind',1,'cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259');
CREATE TABLE study_slots (
  id text primary key,
  study_id text not null,
  participant text not null,
  position bigint not null,
  attempt bigint not null,
  case_id text not null references cases (id),
  state text not null,
  station_id text references stations (id),
  repeat_of text references study_slots (id),
  changed_utc_us bigint not null,
  foreign key (study_id, participant) references study_participants (study_id, name),
  unique (study_id, participant, position, attempt)
);
INSERT INTO "study_slots" VALUES('027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457','a-01a21b8732035ad97af1aec3','Pexqtskrn',0,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','recorded','01a21b87317e7f2e4e53fd59019a9e95',NULL,1795758175465019);
INSERT INTO "study_slots" VALUES('3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b','a-01a21b8732035ad97af1aec3','Pexqtskrn',1,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','recorded','01a21b87317e7f2e4e53fd59019a9e95',NULL,1795758176049021);
INSERT INTO "study_slots" VALUES('2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec','a-01a21b8732035ad97af1aec3','Pexqtskrn',2,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','taken','01a21b87317e7f2e4e53fd59019a9e95',NULL,1795758177589585);
INSERT INTO "study_slots" VALUES('bd985e1885ca68e4fc928add7ffbccc615d0b956437d0f3fee4d2d246ba907c2','a-01a21b8732035ad97af1aec3','Pexqtskrn',3,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','waiting',NULL,NULL,1795758174746725);
INSERT INTO "study_slots" VALUES('e78f23d1078cb32e2e0b3b24925568da79c22372e08c921dbd3c587085b26235','a-01a21b8732035ad97af1aec3','Pf0qn30ka',0,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','waiting',NULL,NULL,1795758174746725);
INSERT INTO "study_slots" VALUES('a2bb76dda58ebce310839217d9dbf1efb177846405867d9df4d6fd1557f2f4cc','a-01a21b8732035ad97af1aec3','Pf0qn30ka',1,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','waiting',NULL,NULL,1795758174746725);
INSERT INTO "study_slots" VALUES('edcc1b514f90e05cfb326784fd4e925b90f1574d265a243367c044be610c8883','a-01a21b8732035ad97af1aec3','Pf0qn30ka',2,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','waiting',NULL,NULL,1795758174746725);
INSERT INTO "study_slots" VALUES('5f3dc7b62da7975677b6fc828bf88b2f715a684a0af18bae28e608bda5e174eb','a-01a21b8732035ad97af1aec3','Pf0qn30ka',3,0,'609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','waiting',NULL,NULL,1795758174746725);
INSERT INTO "study_slots" VALUES('f9208a4644f7b8e2c9297f62ac9eab107f900142df85f84f62140b1e1f58a5d8','blind','S01',0,0,'6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6','waiting',NULL,NULL,1795758176245163);
INSERT INTO "study_slots" VALUES('dcb4e583f8d2d0dc758e382c39598b45e939fd6b94c2b0512a1a135c879f5558','blind','S01',1,0,'cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259','waiting',NULL,NULL,1795758176245163);
INSERT INTO "study_slots" VALUES('a7debf493ba33531d0c0bc908d7debb511575fd3b7345125ca2cc339704bc1f6','blind','S02',0,0,'6ad61be202ddc5da3d9db0bd18a22c53e59b9d2c85852474c2c6d93ff34e66a6','waiting',NULL,NULL,1795758176245163);
INSERT INTO "study_slots" VALUES('3bdde79f3517eceb1be8c0b9a7acfb9b2f0e9bf7df6bb35996ff9f5004d12edd','blind','S02',1,0,'cc3260851dcf65b98a114f6629e58031ab25440253a369ee449a44432a716259','waiting',NULL,NULL,1795758176245163);
CREATE TABLE study_trials (
  trial_id text primary key references uploads (trial_id),
  slot_id text not null references study_slots (id),
  state text not null,
  reason text not null,
  changed_utc_us bigint not null
, tool text not null default 'probe');
INSERT INTO "study_trials" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457','counts','',1795758175465019,'probe');
INSERT INTO "study_trials" VALUES('e4076927382719e4c0cbe2410d49aa8d','3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b','counts','',1795758176049021,'probe');
INSERT INTO "study_trials" VALUES('b35e0d379eb5a75f4e9355dc753181ff','2adc94a60a9cdd8d768d7b2977f0de05b1b26a57b77f3884c894519218d162ec','arriving','',1795758177607969,'probe');
CREATE TABLE trial_clocks (
  trial_id text primary key references trials (id),
  offset_s double precision not null,
  error_s double precision not null
);
CREATE TABLE trial_comments (
  id text primary key,
  trial_id text not null references trials (id),
  at_s double precision,
  text text not null,
  by_id text not null references accounts (id),
  by_name text not null,
  made_utc_us bigint not null
);
INSERT INTO "trial_comments" VALUES('01a21b8737376ca0cab6fa9745feb70c','ac24782dbaf7ce0495cbf2a77e1708d0',0.1,'hold the drill steadier','01a21b86ef0d270c0713f2e70b977c1b','fay',1795758176055073);
CREATE TABLE trial_entries (
  trial_id text primary key references trials (id),
  started_utc_us bigint not null,
  duration_s double precision not null,
  case_title text not null,
  station text not null,
  person text not null,
  correct bigint,
  state text not null,
  study_id text,
  participant text,
  account_id text,
  words text not null
);
INSERT INTO "trial_entries" VALUES('e4076927382719e4c0cbe2410d49aa8d',1770000120000000,1.19000000000000008548e-01,'Hard bone','station-1','tom',0,'assessed','a-01a21b8732035ad97af1aec3','Pexqtskrn','01a21b87159550c045e5bdb289cfff5b','Hard bone station-1 participant tom');
INSERT INTO "trial_entries" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0',1770000060000000,1.19000000000000008548e-01,'Hard bone','station-1','tom',0,'assessed','a-01a21b8732035ad97af1aec3','Pexqtskrn','01a21b87159550c045e5bdb289cfff5b','Hard bone station-1 participant tom');
CREATE TABLE trial_metrics (
  trial_id text not null references trials (id),
  metric_id text not null,
  position bigint not null,
  value double precision,
  note text not null,
  primary key (trial_id, metric_id)
);
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','answer_right',0,0.0,'a breach was felt where there is none');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_force',1,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_force_mean',2,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_force_variance',3,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_time',4,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_velocity_mean',5,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_velocity_onset',6,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_velocity_peak',7,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breach_velocity_variance',8,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','breaches',9,0.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','economy_of_motion',10,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','force_impulse',11,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','force_rate_max',12,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','late_ticks',13,0.0,'and 0 skipped');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','log_dimensionless_jerk',14,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','missed_periods',15,0.0,'0 late, 0 failed, 0 skipped');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','motion_smoothness',16,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','pause_time',17,0.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','pauses',18,0.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','probing_force_mean',19,101.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','probing_force_variance',20,0.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','probing_time',21,1.19000000000000008548e-01,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','probing_velocity_variance',22,0.0,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','probing_work',23,6.00949999999999873168e-01,'');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','spectral_arc_length',24,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','speed_peaks',25,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','tip_speed_max',26,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','tip_speed_mean',27,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','tremor_rms',28,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','answer_right',0,0.0,'a breach was felt where there is none');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_force',1,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_force_mean',2,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_force_variance',3,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_time',4,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_velocity_mean',5,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_velocity_onset',6,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_velocity_peak',7,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breach_velocity_variance',8,NULL,'no wall was breached');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','breaches',9,0.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','economy_of_motion',10,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','force_impulse',11,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','force_rate_max',12,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','late_ticks',13,0.0,'and 0 skipped');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','log_dimensionless_jerk',14,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','missed_periods',15,0.0,'0 late, 0 failed, 0 skipped');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','motion_smoothness',16,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','pause_time',17,0.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','pauses',18,0.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','probing_force_mean',19,102.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','probing_force_variance',20,0.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','probing_time',21,1.19000000000000008548e-01,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','probing_velocity_variance',22,0.0,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','probing_work',23,6.06900000000000883204e-01,'');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','spectral_arc_length',24,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','speed_peaks',25,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','tip_speed_max',26,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','tip_speed_mean',27,NULL,'the trial is shorter than 0.2 s');
INSERT INTO "trial_metrics" VALUES('e4076927382719e4c0cbe2410d49aa8d','tremor_rms',28,NULL,'the trial is shorter than 0.2 s');
CREATE TABLE trials (
  id text primary key references uploads (trial_id),
  case_id text not null references cases (id),
  station_id text not null references stations (id),
  sha256 text not null references objects (sha256),
  operator_name text not null,
  simulated bigint not null,
  started_utc_us bigint not null,
  received_utc_us bigint not null,
  duration_s double precision not null,
  samples bigint not null,
  complete bigint not null,
  late_ticks bigint not null,
  not_converged bigint not null,
  skipped_ticks bigint not null,
  header text not null,
  events text not null,
  state text not null,
  failure text not null,
  correct bigint,
  coverage text
);
INSERT INTO "trials" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','01a21b87317e7f2e4e53fd59019a9e95','9b95cc05d15f77e633a89527918523840dcbd0e0e8c6fe1ec4890ff9d6fa7561','participant',0,1770000060000000,1795758175465019,1.19000000000000008548e-01,120,1,0,0,0,'{"format":"tractus-trial/2","id":"ac24782dbaf7ce0495cbf2a77e1708d0","case_id":"027da73d839526f95abadff2f0cfdf4d37047d036996089981ebd97fa8609457","station":"station","operator":"participant","simulated":false,"device":"sim-rig","started_utc_us":1770000060000000,"rate_Hz":1000.0,"probe":{"travel_m":0.028},"extra":{},"rig":"probing"}','[{"t_s":0.0,"kind":"start","detail":{}},{"t_s":0.12,"kind":"answer","detail":{"breach":true,"wall":null,"confidence":0.75,"depth_m":0.021}},{"t_s":0.12,"kind":"end","detail":{}}]','assessed','',0,'null');
INSERT INTO "trials" VALUES('e4076927382719e4c0cbe2410d49aa8d','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57','01a21b87317e7f2e4e53fd59019a9e95','ef919ecd56c848728a551087bec6226158f895b52a0cc493ac2b8c606f5edbea','participant',0,1770000120000000,1795758176049021,1.19000000000000008548e-01,120,1,0,0,0,'{"format":"tractus-trial/2","id":"e4076927382719e4c0cbe2410d49aa8d","case_id":"3d440df56cd83c0f55fe427a931ea9f1024bb9de2ab163b5e7e78e04346bb53b","station":"station","operator":"participant","simulated":false,"device":"sim-rig","started_utc_us":1770000120000000,"rate_Hz":1000.0,"probe":{"travel_m":0.028},"extra":{},"rig":"probing"}','[{"t_s":0.0,"kind":"start","detail":{}},{"t_s":0.12,"kind":"answer","detail":{"breach":true,"wall":null,"confidence":0.75,"depth_m":0.021}},{"t_s":0.12,"kind":"end","detail":{}}]','assessed','',0,'null');
CREATE TABLE uploads (
  trial_id text primary key,
  station_id text not null references stations (id),
  case_id text not null references cases (id),
  size_bytes bigint not null,
  sha256 text not null,
  state text not null,
  announced_utc_us bigint not null
);
INSERT INTO "uploads" VALUES('ac24782dbaf7ce0495cbf2a77e1708d0','01a21b87317e7f2e4e53fd59019a9e95','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57',8407,'9b95cc05d15f77e633a89527918523840dcbd0e0e8c6fe1ec4890ff9d6fa7561','complete',1795758175401666);
INSERT INTO "uploads" VALUES('e4076927382719e4c0cbe2410d49aa8d','01a21b87317e7f2e4e53fd59019a9e95','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57',8407,'ef919ecd56c848728a551087bec6226158f895b52a0cc493ac2b8c606f5edbea','complete',1795758175995677);
INSERT INTO "uploads" VALUES('b35e0d379eb5a75f4e9355dc753181ff','01a21b87317e7f2e4e53fd59019a9e95','609686f0e43cfd6114f5b42741d1f5e5ea57ea302b3395d67787a26b6dfbcc57',8407,'d8be5723312ffa78a9b9750cb2cfe918ed43de624687c67571e15c5ed4f2cd1c','receiving',1795758177607969);
CREATE TABLE volumes (
  id text primary key,
  name text not null,
  source text not null,
  state text not null,
  sha256 text references objects (sha256),
  size_bytes bigint not null,
  facts text not null,
  report text not null,
  made_utc_us bigint not null,
  made_by text not null,
  made_by_id text not null,
  decided_utc_us bigint,
  decided_by text,
  reason text not null default ''
);
CREATE TABLE webhooks (
  id text primary key,
  url text not null,
  kinds text not null,
  secret text not null,
  made_utc_us bigint not null,
  made_by text not null
);
CREATE INDEX uploads_by_station on uploads (station_id, state);
CREATE INDEX trials_by_start on trials (started_utc_us, id);
CREATE INDEX trials_by_case on trials (case_id);
CREATE INDEX jobs_by_state on jobs (state, queued_utc_us);
CREATE INDEX study_trials_by_slot on study_trials (slot_id);
CREATE INDEX analysis_plans_by_time on analysis_plans (made_utc_us, id);
CREATE INDEX analyses_by_plan on analyses (plan_id, made_utc_us);
CREATE INDEX analyses_by_snapshot on analyses (snapshot);
CREATE INDEX lab_runs_by_time on lab_runs (made_utc_us, id);
CREATE UNIQUE INDEX accounts_by_pseudonym on accounts (pseudonym);
CREATE UNIQUE INDEX accounts_by_badge on accounts (badge);
CREATE INDEX cohort_people_by_account on cohort_people (account_id, part);
CREATE INDEX assignment_people_by_account on assignment_people (account_id);
CREATE INDEX volumes_by_object on volumes (sha256);
CREATE INDEX oidc_subjects_by_account on oidc_subjects (account_id);
CREATE INDEX case_makings_by_time on case_makings (made_utc_us, id);
CREATE INDEX scenario_versions_by_time on scenario_versions (made_utc_us, id);
CREATE INDEX trial_comments_by_trial on trial_comments (trial_id, made_utc_us);
CREATE INDEX cohort_invitations_by_name on cohort_invitations (account_name);
CREATE INDEX sign_in_failures_by_time on sign_in_failures (at_utc_us);
CREATE INDEX known_origins_by_origin on known_origins (secret, origin);
CREATE INDEX audit_by_coverage on audit (number) where what = 'beginCoverage';
CREATE INDEX curriculum_steps_by_curriculum on curriculum_steps (curriculum_id, version);
CREATE INDEX trial_entries_by_start on trial_entries (started_utc_us, trial_id);
CREATE INDEX trial_entries_by_case on trial_entries (case_title, trial_id);
CREATE INDEX trial_entries_by_person on trial_entries (person, trial_id);
CREATE INDEX trial_entries_by_station on trial_entries (station, trial_id);
CREATE INDEX trial_entries_by_duration on trial_entries (duration_s, trial_id);
CREATE INDEX trial_entries_by_account on trial_entries (account_id);
CREATE INDEX study_slots_open on study_slots (study_id, participant) where state in ('waiting', 'taken');
CREATE INDEX assignment_entries_by_urgency on assignment_entries (finished, due_utc_us, study_id);
CREATE INDEX assignment_entries_by_due on assignment_entries (due_utc_us, study_id);
CREATE INDEX assignment_entries_by_time on assignment_entries (made_utc_us, study_id);
CREATE INDEX assignment_entries_by_title on assignment_entries (title, study_id);
CREATE INDEX assignment_entries_by_cohort_name on assignment_entries (cohort_name, study_id);
CREATE INDEX assignment_entries_by_maker on assignment_entries (made_by_id);
CREATE INDEX assignment_entries_by_cohort on assignment_entries (cohort_id);
CREATE INDEX assigned_progress_by_participant on assigned_progress (study_id, participant);
CREATE INDEX accounts_by_name on accounts (name, id);
CREATE INDEX accounts_by_role on accounts (role, name, id);
CREATE INDEX accounts_by_level on accounts (level, name, id);
CREATE INDEX accounts_by_time on accounts (made_utc_us, id);
CREATE INDEX audit_by_who on audit (who, number);
CREATE INDEX audit_by_what on audit (what, number);
CREATE INDEX cases_by_publication on cases (kind, published_utc_us, id);
CREATE INDEX cases_by_title on cases (kind, title, id);
CREATE INDEX cases_by_source on cases (kind, source, id);
CREATE INDEX cases_by_time on cases (kind, made_utc_us, id);
CREATE INDEX ratings_by_rater on ratings (rater_id);
CREATE INDEX api_tokens_by_account on api_tokens (account_id);
CREATE INDEX notification_events_new on notification_events (at_utc_us, id) where spread = 0;
CREATE INDEX deliveries_waiting on deliveries (channel, due_utc_us, id) where state = 'waiting';
CREATE INDEX deliveries_by_change on deliveries (changed_utc_us);
CREATE INDEX erased_trials_by_erasure on erased_trials (erasure, deleted);
COMMIT;
