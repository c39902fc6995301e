import { useEffect } from 'react';
import { Dialog as AriaDialog, Heading, Modal, ModalOverlay } from 'react-aria-components';
import { useTranslation } from 'react-i18next';

import { Button } from './button';
import css from './dialog.module.css';
import { StopButton } from './stop-button';

interface Props {
  title: string;
  isOpen: boolean;
  onClose: () => void;
  children: React.ReactNode;
  /** `alertdialog` for what must not be closed by a tap beside it. */
  role?: 'dialog' | 'alertdialog';
}

/** A box over the page. */
export function Dialog({ title, isOpen, onClose, children, role = 'dialog' }: Props) {
  const { t } = useTranslation('common');
  // The browser's way back leaves the page that the box belongs to.
  useEffect(() => {
    if (!isOpen) return undefined;
    window.addEventListener('hashchange', onClose);
    return () => window.removeEventListener('hashchange', onClose);
  }, [isOpen, onClose]);
  return (
    <ModalOverlay
      className={css.overlay ?? ''}
      isOpen={isOpen}
      isDismissable={role === 'dialog'}
      onOpenChange={(open) => {
        if (!open) onClose();
      }}
    >
      <Modal className={css.modal ?? ''}>
        <AriaDialog role={role} className={css.dialog ?? ''}>
          <header className={css.head}>
            <Heading slot="title">{title}</Heading>
            {/* The page behind is out of reach while this is open; stopping must not be. */}
            <StopButton />
            <Button tone="quiet" icon="close" iconOnly aria-label={t('close')} onPress={onClose} />
          </header>
          {children}
        </AriaDialog>
      </Modal>
    </ModalOverlay>
  );
}

/** The row of buttons at the end of a box. */
export function DialogButtons({ children }: { children: React.ReactNode }) {
  return <div className={css.buttons}>{children}</div>;
}
