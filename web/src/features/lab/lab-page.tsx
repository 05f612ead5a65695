import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { useLocation } from 'wouter';
import { measurementsQuery, modelsQuery } from '@/api';
import { say, Sentence } from '@/language';
import { Button, Skeleton, useTitle } from '@/ui';
import styles from './lab.module.css';
import { ModelsCard } from './models-card';
import { RunsCard } from './runs-card';
import { SetsCard } from './sets-card';
import { workAddress } from './names';

/** Start page of the lab: choose measurements and a model. */
export function LabPage() {
  useTitle(say('Model lab'));
  const [, go] = useLocation();
  const [pickedSet, setSet] = useState<string | null>(null);
  const [pickedModel, setModel] = useState<string | null>(null);
  const setsAsked = useQuery(measurementsQuery),
    modelsAsked = useQuery(modelsQuery);
  const sets = setsAsked.data?.measurements,
    models = modelsAsked.data?.models;
  const set = sets?.find(({ id }) => id === pickedSet) ?? sets?.[0];
  const fitting = models?.filter(({ rig }) => !set?.rig || rig === set.rig);
  const model = fitting?.find(({ id }) => id === pickedModel) ?? fitting?.[0];
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Model lab')}</h1>
        <p className={styles.lead}>
          {say(
            'Compare the model of a simulator with measurements, find where it fails and which physical effect is missing, add this effect, and check that the error decreases.',
          )}
        </p>
      </div>
      {/* Both lists at once: one that came later would push the rest of the page down. Fetched, not pending: a list that failed is
          fetched again when it is shown, and would be hidden by that. */}
      {!setsAsked.isFetched || !modelsAsked.isFetched ? (
        <Skeleton height="60vh" />
      ) : (
        <>
          <div className={styles.two}>
            <SetsCard chosen={set?.id ?? null} choose={setSet} />
            <ModelsCard rig={set?.rig ?? null} chosen={model?.id ?? null} choose={setModel} />
          </div>
          <div className={styles.go}>
            <p className={styles.muted}>
              {set && model ? (
                <Sentence
                  text="Compare <strong>{model}</strong> with <strong>{set}</strong>"
                  values={{ model: model.name, set: set.name }}
                  parts={{ strong: (words) => <strong>{words}</strong> }}
                />
              ) : (
                say('Select measurements and a model.')
              )}
            </p>
            <Button
              look="solid"
              disabled={!set || !model}
              onClick={() => {
                if (set && model) go(workAddress(model.id, set.id));
              }}
            >
              {say('Compare')}
            </Button>
          </div>
          <RunsCard />
        </>
      )}
    </div>
  );
}
